// SPDX-License-Identifier: BSD-3-Clause
// What the samples of a picture mean: which channels are colour, how they are decoded to linear light, and what their
// luminance is.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Replaces `count` numbers by their base-2 logarithms. Numbers below 2^-126, zero and negative ones among them, count as
/// 2^-126.
PIMG_EXPORT void log2_in_place(float* values, std::size_t count);
/// Replaces `count` numbers x by 2^x. Numbers outside -126..127 count as the nearer end of this range.
PIMG_EXPORT void exp2_in_place(float* values, std::size_t count);

/// The colour space that the file rules of the OpenColorIO configuration in $OCIO give a file of that name. Empty if there
/// is no configuration, and if only its default rule applies, which says nothing about the file.
PIMG_EXPORT std::string space_by_file_rule(const std::string& filename);

/// Whether $OCIO is unset or names a configuration that can be read. If not, `error` says why in one line.
PIMG_EXPORT bool check_colour_config(std::string& error);

/// How the colour of one picture is understood. It does not change once resolved, and may be shared between threads.
class PIMG_EXPORT Colour {
public:
    /// Finds out the colour space of a picture. The first of these that says something decides:
    ///   1. `space`, the option incolorspace;
    ///   2. the metadata CICP and ICCProfile, if oiio:ColorSpace says no more than what files of the format usually are;
    ///   3. the metadata oiio:ColorSpace or colorInteropID, if it names a known space other than just "Linear";
    ///   4. the type of the samples: floating-point samples are linear, and whole numbers are sRGB unless the metadata
    ///      call them "Linear". Samples of a PFM file are linear, whatever OpenImageIO calls them.
    /// The primaries of linear samples that no name tells are those of the attribute chromaticities; without it, the
    /// samples are scene-linear.
    ///
    /// Names are looked up in the OpenColorIO configuration of $OCIO, if that is set, and then among pimg's own: linear,
    /// srgb, rec709, gammaX.Y, acescg, aces2065-1, and CURVE_PRIMARIES as in lin_rec2020, g22_adobergb or
    /// srgb_p3d65_scene. Scene-linear is the role scene_linear of that configuration, and linear Rec. 709 without one.
    /// Encoded pictures are decoded to it.
    ///
    /// The primaries of a space of a configuration are found by converting red, green and blue to a space with known
    /// primaries: the role aces_interchange, else a scene-referred role cie_xyz_d65_interchange or space XYZ. Without
    /// these they are taken from the space's name. If that does not tell them either, they count as those of Rec. 709,
    /// and luminance has the configuration's luma coefficients.
    ///
    /// Fails, with one line in `error`, when `space` or `layer` is unknown, when several layers may be the picture, and
    /// when $OCIO names a configuration that cannot be read.
    static bool resolve(const OIIO::ImageSpec& spec, const std::string& space, const std::string& layer, Colour& colour,
                        std::string& error);
    /// The same for the layer that is the picture when none is named.
    static bool resolve(const OIIO::ImageSpec& spec, const std::string& space, Colour& colour, std::string& error)
    {
        return resolve(spec, space, {}, colour, error);
    }

    /// The number of colour channels, 1 to 3, and the channel of the picture that is colour channel `i`. Colour channels
    /// are those of `layer`. Without one they are R, G and B if the picture has channels so named, else those of the
    /// layer rgba, Color, beauty, Combined or C, else those of the only layer that has all three. Else they are the first
    /// three channels that are neither alpha nor depth and have no layer, or the only one. No others are filtered.
    int count() const { return m_count; }
    int channel(int i) const { return m_channels[std::size_t(i)]; }
    bool is_colour(int channel) const;
    /// Their alpha, or -1.
    int alpha() const { return m_alpha; }

    /// Whether samples are encoded, that is must be decoded to become linear light.
    bool encoded() const { return m_decoder != nullptr; }
    /// Decodes `count` RGB triples in place. Linear samples stay as they are.
    void decode(float* rgb, std::size_t count) const;

    /// Converts `count` RGB triples of decoded samples in place to linear Rec. 709, the primaries of results made for
    /// displays, and back. Pictures that have these primaries stay as they are. White becomes equal R, G and B, whatever
    /// the white point of the picture.
    void to_rec709(float* rgb, std::size_t count) const;
    void from_rec709(float* rgb, std::size_t count) const;
    bool has_rec709_primaries() const { return !m_converts; }

    /// The relative luminance of a linear RGB triple: Y of the same colour in Rec. 709, so that it does not depend on the
    /// primaries a scene is stored with. It is never below 3 % of the largest channel: colours outside the gamut may have
    /// a Y of 0 or less, and the ratio of a channel to the luminance must stay finite.
    float luminance(const float* rgb) const
    {
        const float y = m_weights[0] * rgb[0] + m_weights[1] * rgb[1] + m_weights[2] * rgb[2];
        const float most = rgb[0] > rgb[1] ? rgb[0] : rgb[1];
        const float floor = 0.03f * (most > rgb[2] ? most : rgb[2]);
        return y < floor ? floor : y;
    }
    /// The weights of R, G and B in the luminance.
    const std::array<float, 3>& weights() const { return m_weights; }

    /// What the samples are taken to be, and why: a few words for people to read.
    const std::string& description() const { return m_description; }

    /// Sets the metadata of a picture of decoded samples: oiio:ColorSpace and, where that does not tell the primaries,
    /// chromaticities.
    void declare_linear(OIIO::ImageSpec& spec) const;

    /// The name of the space of the samples as stored: in the configuration of $OCIO or, without one, in OpenImageIO.
    /// Empty if it has none there.
    const std::string& config_name() const { return m_config_name; }
    /// Converts `count` RGB triples, as stored, in place to scene-linear; see resolve(). Returns whether that is possible.
    bool to_scene_linear(float* rgb, std::size_t count) const;

    struct Decoder;

private:
    bool m_converts = false;  ///< the matrices are not the identity
    std::array<float, 9> m_to_rec709 {}, m_from_rec709 {};
    std::array<float, 3> m_weights { 0.2126f, 0.7152f, 0.0722f };
    std::array<int, 3> m_channels { 0, 0, 0 };
    int m_count = 0, m_alpha = -1;
    std::shared_ptr<const Decoder> m_decoder;
    std::string m_linear_name = "Linear";
    std::string m_config_name, m_description;
    std::vector<float> m_chromaticities;  ///< of decoded samples; 8 or, where the name says it all, none

    friend struct ColourFinder;
};

/// Whether a channel beside the picture's holds data rather than light, as its name (crypto, depth, normal, position,
/// motion, UV, IDs) or its type (32-bit integers) says.
PIMG_EXPORT bool holds_data(const OIIO::ImageSpec& spec, int channel, const Colour& colour);

}  // namespace PIMG_ABI
}  // namespace pimg
