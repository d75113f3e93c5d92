// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/display.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/rec709.h>
#include <pimg/threads.h>

#include "base/float_copy.h"
#include "colour/icc.h"
#include "colour/primaries.h"
#include "colour/spaces.h"

namespace pimg {
inline namespace PIMG_ABI {

using OIIO::ImageBuf;

namespace {

/// The attribute of declare_gamut().
constexpr const char* kDisplayGamut = "DisplayGamut";

Imath::M33d rec709_to(const Chromaticities& primaries)
{
    Imath::M33d matrix, inverse;
    matrix_to_rec709(primaries, matrix);
    invert(matrix, inverse);
    return inverse;
}

/// Applies the curve of a display. Colours may be stored multiplied by alpha; the curve is for the colours without it.
class Encoder {
public:
    /// `colour` says which channels are colours and, for linear samples, what their primaries are.
    Encoder(const OIIO::ImageSpec& spec, const Colour& colour)
        : m_spec(spec),
          m_colour(colour),
          m_wide(is_wide(spec, colour))
    {
    }

    /// Whether the result has the primaries of Display P3.
    static bool is_wide(const OIIO::ImageSpec& spec, const Colour& colour)
    {
        return colour.count() == 3 && !colour.encoded() && spec.get_string_attribute(kDisplayGamut) == "p3";
    }

    void encode(float* row) const
    {
        std::vector<float> rgb(3 * std::size_t(m_spec.width));
        for_colours(row, [&](int x, int c, float& sample, float alpha) {
            const float straight = sample / alpha;
            for (int i = c; i < (m_colour.count() < 3 ? 3 : c + 1); ++i)
                rgb[std::size_t(3 * x + i)] = straight;
        });
        if (m_colour.count() == 3 && !m_colour.encoded())
            m_colour.to_rec709(rgb.data(), std::size_t(m_spec.width));
        if (m_wide)
            to_p3(rgb);
        srgb_in_place(rgb.data(), rgb.size());
        for_colours(row,
                    [&](int x, int c, float& sample, float alpha) { sample = rgb[std::size_t(3 * x + c)] * alpha; });
    }

private:
    static void to_p3(std::vector<float>& rgb)
    {
        static const Imath::M33f matrix(rec709_to(kP3));
        for (std::size_t i = 0; i < rgb.size(); i += 3) {
            const Imath::V3f p = Imath::V3f(rgb[i], rgb[i + 1], rgb[i + 2]) * matrix;
            for (int c = 0; c < 3; ++c)
                rgb[i + std::size_t(c)] = p[c];
        }
    }

    /// Calls body(x, number of the colour, sample, alpha or 1).
    template<class Body>
    void for_colours(float* row, Body&& body) const
    {
        for (int x = 0; x < m_spec.width; ++x, row += m_spec.nchannels) {
            const float a = m_colour.alpha() >= 0 ? row[m_colour.alpha()] : 1.0f;
            for (int c = 0; c < m_colour.count(); ++c)
                body(x, c, row[m_colour.channel(c)], a > 0.0f ? a : 1.0f);
        }
    }

    const OIIO::ImageSpec& m_spec;
    const Colour& m_colour;
    bool m_wide;
};

/// Metadata of pictures made for displays.
void declare_display(OIIO::ImageSpec& spec, bool wide)
{
    declare_space(spec, wide ? "srgb_p3d65_display" : "sRGB");
    if (!wide)
        return;
    const std::string profile = display_p3_profile();
    spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(profile.size())), profile.data());
}

}  // namespace

ImageBuf srgb_encoded(const ImageBuf& src, int nthreads, const std::string& layer)
{
    ImageBuf dst;
    const bool copied = copy_as_float(dst, src);
    if (!copied && !dst.has_error())
        set_error(dst, src.has_error() ? src.geterror(false) : "the picture has no pixels");
    const OIIO::ImageSpec& spec = dst.spec();
    std::string error;
    Colour colour;
    if (copied && !Colour::resolve(spec, "", layer, colour, error)) {
        set_error(dst, error);
        return dst;
    }
    if (copied && dst.localpixels() != nullptr)
        for_rows(pool_loop(nthreads), 0, spec.height * std::max(spec.depth, 1), [&](int row) {
            Encoder(spec, colour)
                .encode(static_cast<float*>(dst.localpixels())
                        + std::size_t(row) * std::size_t(spec.width) * std::size_t(spec.nchannels));
        });
    declare_display(dst.specmod(), Encoder::is_wide(spec, colour));
    return dst;
}

double srgb_decoded(double encoded)
{
    return std::isfinite(encoded) ? elementary::srgb_decoded(encoded) : encoded;
}

void declare_gamut(OIIO::ImageSpec& spec, const std::string& gamut)
{
    if (gamut == "p3")
        spec.attribute(kDisplayGamut, gamut);
    else
        spec.erase_attribute(kDisplayGamut);
}

void declare_space(OIIO::ImageSpec& spec, const std::string& space)
{
    for (const char* stale : { "oiio:Gamma", "Exif:ColorSpace", "ICCProfile", "tiff:ColorSpace", "png:gAMA",
                               "chromaticities", "colorInteropID", "CICP" })
        spec.erase_attribute(stale);
    if (space.empty())
        spec.erase_attribute("oiio:ColorSpace");
    else
        spec.attribute("oiio:ColorSpace", space);
}

}  // namespace PIMG_ABI
}  // namespace pimg
