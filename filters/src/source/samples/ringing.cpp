// SPDX-License-Identifier: BSD-3-Clause
#include "source/samples/ringing.h"

#include <algorithm>

#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye on the photographs of docs/look.md.
constexpr float kImplausible = 0x1p-5f;  ///< share of the light around it below which a pixel is no part of the scene
constexpr float kBesideLight = 0x1p-3f;  ///< the same beside a light: lobes of filters take that much of what is around
constexpr float kLight = 32.0f;  ///< how far a light outshines its surroundings; a lobe is a tenth of it or less
constexpr float kKept = 0.75f;   ///< share of the light around that a filled pixel gets

class Finder {
public:
    Finder(const OIIO::ImageBuf& picture, const Colour& colour, const Raster& luminance)
        : m_picture(picture),
          m_colour(colour),
          m_luminance(luminance)
    {
    }

    /// Appends those of row y.
    void find(int y, std::vector<FilledPixel>& found) const
    {
        for (int x = 0; x < m_luminance.width; ++x) {
            if (!is_dark(x, y))
                continue;
            const float around = light_around(x, y);
            if (around > 0.0f && rings(x, y, around))
                found.push_back({ index(x, y), colour_around(x, y, kKept * around) });
        }
    }

private:
    Index index(int x, int y) const { return Index(y) * Index(m_luminance.width) + Index(x); }
    float at(int x, int y) const { return m_luminance.samples[index(x, y)]; }

    template<class Body>
    void for_square(int x, int y, int radius, Body&& body) const
    {
        for (int j = std::max(y - radius, 0); j <= std::min(y + radius, m_luminance.height - 1); ++j)
            for (int i = std::max(x - radius, 0); i <= std::min(x + radius, m_luminance.width - 1); ++i)
                body(i, j);
    }

    /// A quick test first, which few pixels pass.
    bool is_dark(int x, int y) const
    {
        const float here = at(x, y);
        float most = 0.0f;
        for_square(x, y, 1, [&](int i, int j) { most = std::max(most, at(i, j)); });
        return here <= most * kBesideLight;
    }

    bool has_negative_channel(int x, int y) const
    {
        float rgb[3];
        linear_pixels(m_picture, m_colour, index(x, y), 1, rgb);
        return std::min({ rgb[0], rgb[1], rgb[2] }) < 0.0f;
    }

    bool is_transparent(int x, int y) const
    {
        const OIIO::ImageSpec& spec = m_picture.spec();
        return m_colour.alpha() >= 0
            && static_cast<const float*>(m_picture.pixeladdr(spec.x + x, spec.y + y))[m_colour.alpha()] < kLeastAlpha;
    }

    /// The median of the light of those of the 24 pixels around that have any; 0 unless most of the 24 are plausibly
    /// lit.
    float light_around(int x, int y) const
    {
        float lit[25];
        int all = -1, count = 0;  // -1 because the pixel itself does not count
        for_square(x, y, 2, [&](int i, int j) {
            ++all;
            if (at(i, j) > 0.0f)
                lit[count++] = at(i, j);
        });
        if (count == 0)
            return 0.0f;
        std::sort(lit, lit + count);
        const float around = lit[count / 2];
        const auto plausible = std::count_if(lit, lit + count, [&](float l) { return l > around * kImplausible; });
        return 2 * plausible > all ? around : 0.0f;
    }

    bool rings(int x, int y, float around) const
    {
        if (at(x, y) > around * kBesideLight || is_transparent(x, y))
            return false;
        if (at(x, y) <= around * kImplausible && has_negative_channel(x, y))
            return true;
        float light = 0.0f;
        for_square(x, y, 3, [&](int i, int j) { light = std::max(light, at(i, j)); });
        return light >= kLight * around;
    }

    /// A colour of the given luminance: the mean colour of the lit pixels around. Each counts the same, however light
    /// it is, so that lamps do not outweigh the others.
    std::array<float, 3> colour_around(int x, int y, float luminance) const
    {
        std::array<float, 3> sum { 0.0f, 0.0f, 0.0f };
        for_square(x, y, 2, [&](int i, int j) {
            const float light = at(i, j);
            if (!(light > 0.0f))
                return;
            float rgb[3];
            linear_pixels(m_picture, m_colour, index(i, j), 1, rgb);
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += std::max(rgb[c], 0.0f) / light;
        });
        const float scale = luminance / m_colour.luminance(sum.data());
        for (float& channel : sum)
            channel *= scale;
        return sum;
    }

    const OIIO::ImageBuf& m_picture;
    const Colour& m_colour;
    const Raster& m_luminance;
};

}  // namespace

std::vector<FilledPixel> find_ringing(const OIIO::ImageBuf& picture, const Colour& colour, const Raster& luminance,
                                      const ParallelFor& parallel)
{
    const Finder finder(picture, colour, luminance);
    std::vector<std::vector<FilledPixel>> rows(std::size_t(luminance.height));
    for_rows(parallel, 0, luminance.height, [&](int y) { finder.find(y, rows[std::size_t(y)]); });
    std::vector<FilledPixel> found;
    for (const std::vector<FilledPixel>& row : rows)
        found.insert(found.end(), row.begin(), row.end());
    return found;
}

}  // namespace PIMG_ABI
}  // namespace pimg
