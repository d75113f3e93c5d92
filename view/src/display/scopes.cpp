// SPDX-License-Identifier: BSD-3-Clause
#include "display/scopes.h"

#include <algorithm>
#include <cmath>

#include <pimg/detail/rec709.h>
#include <pimg/display.h>

#include "render/frame.h"

namespace pimgview {

namespace {

/// Makes a frame small enough, calls see(x, luminance) for its pixels, and returns its width.
template<class See>
int for_pixels(const Rendering& rendering, See&& see)
{
    constexpr double kMost = 250000.0;
    const OIIO::ImageSpec& spec = rendering.pixels->spec();
    int reduce = 1;
    while (double(spec.width) * spec.height / (double(reduce) * reduce) > kMost)
        ++reduce;
    const int factor = rendering.factor;
    const Frame frame = make_frame(rendering, { 0, 0, spec.width * factor, spec.height * factor }, reduce);
    const std::array<float, 9>& m = frame.light.to_rec709;
    for (std::size_t i = 0; i < frame.rgb.size() / 3; ++i) {
        const float* rgb = &frame.rgb[3 * i];
        double linear[3];
        for (int c = 0; c < 3; ++c) {
            const double v = double(rgb[c]);
            linear[c] = frame.light.encoded ? pimg::srgb_decoded(v) : v;
        }
        const auto row = [&](std::size_t r) {
            return double(m[3 * r]) * linear[0] + double(m[3 * r + 1]) * linear[1] + double(m[3 * r + 2]) * linear[2];
        };
        double luminance = 0.0;
        for (std::size_t c = 0; c < 3; ++c)
            luminance += double(pimg::elementary::kRec709Weights[c]) * row(c);
        see(int(i % std::size_t(frame.width)), luminance);
    }
    return frame.width;
}

}  // namespace

Histogram histogram_of(const Rendering& rendering)
{
    Histogram histogram;
    float count = 0.0f;
    for_pixels(rendering, [&](int, double luminance) {
        const double stops = luminance > 0.0 ? std::log2(luminance) : double(Histogram::kLeast);
        const double bin = (stops - Histogram::kLeast) * Histogram::kBinsPerStop;
        ++histogram.bins[std::size_t(std::clamp(std::isnan(bin) ? 0.0 : bin, 0.0, Histogram::kBins - 1.0))];
        ++count;
    });
    for (float& bin : histogram.bins)
        bin /= std::max(1.0f, count);
    return histogram;
}

Waveform waveform_of(const Rendering& rendering, int columns)
{
    Waveform waveform;
    waveform.columns = columns;
    waveform.shares.assign(std::size_t(columns) * Waveform::kRows, 0.0f);
    std::vector<std::pair<int, double>> seen;
    const int width = for_pixels(rendering, [&](int x, double luminance) { seen.emplace_back(x, luminance); });
    for (const auto& [x, luminance] : seen) {
        float code = std::isnan(luminance) ? 0.0f : float(std::clamp(luminance, 0.0, 1.0));
        pimg::srgb_in_place(&code, 1);
        const int row = Waveform::kRows - 1 - int(std::lround(code * (Waveform::kRows - 1)));
        ++waveform.shares[std::size_t(row) * std::size_t(columns) + std::size_t(std::int64_t(x) * columns / width)];
    }
    const float most = std::max(1.0f, *std::max_element(waveform.shares.begin(), waveform.shares.end()));
    for (float& share : waveform.shares)
        share /= most;
    return waveform;
}

}  // namespace pimgview
