// SPDX-License-Identifier: BSD-3-Clause
#include "source/lab.h"

#include <cmath>
#include <utility>

#include <pimg/detail/parallel.h>
#include <pimg/detail/rec709.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// CIE 15: the cube root with its linear start. Above white it goes on as a logarithm with the same slope there.
float lightness(float t)
{
    constexpr float kEpsilon = 216.0f / 24389.0f, kKappa = 24389.0f / 27.0f;
    if (t > 1.0f)
        return 1.0f + float(elementary::kLn2 / 3.0 * elementary::log2(double(t)));
    if (t > kEpsilon)
        return float(elementary::cube_root(double(t)));
    return t > 0.0f ? (kKappa * t + 16.0f) / 116.0f : 16.0f / 116.0f;
}

/// X and Z of linear RGB over those of white: Rec. 709 primaries, D65 (IEC 61966-2-1), rows made to add up to one. Y is
/// the luminance.
constexpr float kX[3] = { 0.433910f, 0.376220f, 0.189870f };
constexpr float kZ[3] = { 0.017756f, 0.109469f, 0.872775f };

float dot(const float* w, const float* rgb)
{
    return w[0] * rgb[0] + w[1] * rgb[1] + w[2] * rgb[2];
}

/// Factor that places the median luminance of scene-linear light at 0.18.
float exposure(const std::vector<float>& luminance)
{
    const float median = MagnitudeHistogram(luminance).quantile(0.5);
    return median > 0.0f ? 0.18f / median : 1.0f;
}

}  // namespace

std::vector<std::vector<float>> lab_channels(const OIIO::ImageBuf& picture, const Colour& colour,
                                             const ParallelFor& parallel)
{
    const OIIO::ImageSpec& spec = picture.spec();
    const std::size_t width = std::size_t(spec.width), pixels = spec.image_pixels();
    std::vector<float> rgb(3 * pixels), luminance(pixels);
    for_rows(parallel, 0, spec.height, [&](int y) {
        const std::size_t first = std::size_t(y) * width;
        linear_pixels(picture, colour, Index(first), width, &rgb[3 * first]);
        for (std::size_t p = first; p < first + width; ++p)
            luminance[p] = colour.luminance(&rgb[3 * p]);
        colour.to_rec709(&rgb[3 * first], width);
    });
    const float scale = colour.encoded() ? 1.0f : exposure(luminance);
    std::vector<std::vector<float>> lab(std::size_t(colour.count()), std::vector<float>(pixels));
    for_rows(parallel, 0, spec.height, [&](int y) {
        for (std::size_t p = std::size_t(y) * width; p < std::size_t(y + 1) * width; ++p) {
            float light[3];
            for (std::size_t c = 0; c < 3; ++c)
                light[c] = std::fmin(std::fmax(rgb[3 * p + c] * scale, 0.0f), 1e30f);
            if (colour.count() < 3) {
                for (std::size_t c = 0; c < lab.size(); ++c)
                    lab[c][p] = 116.0f * lightness(light[c]) - 16.0f;
                continue;
            }
            const float fy = lightness(dot(elementary::kRec709Weights.data(), light));
            lab[0][p] = 116.0f * fy - 16.0f;
            lab[1][p] = 500.0f * (lightness(dot(kX, light)) - fy);
            lab[2][p] = 200.0f * (fy - lightness(dot(kZ, light)));
        }
    });
    return lab;
}

std::vector<Raster> lab_guide(const OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel)
{
    std::vector<Raster> channels;
    for (std::vector<float>& samples : lab_channels(picture, colour, parallel)) {
        for (float& sample : samples)
            sample *= 2.55f;
        channels.push_back({ picture.spec().width, picture.spec().height, std::move(samples) });
    }
    return channels;
}

}  // namespace PIMG_ABI
}  // namespace pimg
