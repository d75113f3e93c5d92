// SPDX-License-Identifier: BSD-3-Clause
// What the samples of a picture mean: which channels are colour, their luminance, how they are decoded
// to linear light, and the logarithm. OpenColorIO is used here and nowhere else.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace pimg {

/// log2 of `count` positive numbers in place, by a processor of OpenColorIO that is built once. Numbers below 2^-126
/// count as 2^-126.
void log2_in_place(float* values, std::size_t count);
/// Its inverse, on vectors: several times as fast as a processor. Exponents are clamped to -126..127.
void exp2_in_place(float* values, std::size_t count);

/// The colour space that a rule of the configuration $OCIO names gives files of that name; empty if only the default
/// rule would apply, which says nothing of the file, or there is no configuration.
std::string space_by_file_rule(const std::string& filename);

/// False, with a line saying why, if $OCIO names a configuration that cannot be read.
bool check_colour_config(std::string& error);

/// The colour of one picture. Immutable; may be shared between threads.
class Colour {
public:
    /// Finds out from, in this order:
    ///   1. `space`, the option incolorspace;
    ///   2. oiio:ColorSpace, or colorInteropID, if it says more than "Linear" and is known;
    ///   3. "Linear" or the type: floating-point samples are linear, whole numbers are sRGB unless called linear;
    ///   4. for linear samples the attribute chromaticities, else they are scene-linear.
    /// Names are looked up in the configuration of $OCIO when that is set, then among the engine's own: linear, srgb,
    /// rec709, gammaX.Y, acescg, aces2065-1, and CURVE_PRIMARIES as in lin_rec2020, g22_adobergb or srgb_p3d65_scene.
    /// Scene-linear is the role of that name in the configuration of $OCIO, and Rec. 709 without one. Pictures that are
    /// encoded are decoded into it. The primaries of a space of a configuration are found by converting red, green and
    /// blue to a space whose primaries are known: the role aces_interchange, else a scene-referred role
    /// cie_xyz_d65_interchange or space XYZ; else they are known from the space's name; else they count as Rec. 709 and
    /// luminance has the configuration's luma coefficients. Floats of a PFM are linear, whatever OpenImageIO calls them.
    /// Fails when `space` is unknown or $OCIO cannot be read.
    static bool resolve(const OIIO::ImageSpec& spec, const std::string& space, Colour& colour, std::string& error);

    /// Colour channels: R, G and B if the picture has channels so named, else the first three that are neither alpha
    /// nor depth. Everything else is never filtered.
    int count() const { return m_count; }
    int channel(int i) const { return m_channels[std::size_t(i)]; }
    bool is_colour(int channel) const;

    /// Whether samples must be decoded to become linear light.
    bool encoded() const { return m_decoder != nullptr; }
    /// Decodes `count` RGB triples in place; nothing to do for linear samples.
    void decode(float* rgb, std::size_t count) const;

    /// Converts `count` triples of decoded samples to linear Rec. 709, the primaries of the results made for displays, and
    /// back. Nothing to do for pictures that have them. Whites become equal RGB.
    void to_rec709(float* rgb, std::size_t count) const;
    void from_rec709(float* rgb, std::size_t count) const;
    bool has_rec709_primaries() const { return !m_converts; }

    /// Relative luminance of linear RGB: Y of its colour in Rec. 709, whatever its primaries, so that it does not depend on
    /// what a scene is stored in. Never below 3 % of the largest channel, so
    /// that colours outside the gamut, whose Y may vanish or be negative, keep a finite ratio to it.
    float luminance(const float* rgb) const
    {
        const float y = m_weights[0] * rgb[0] + m_weights[1] * rgb[1] + m_weights[2] * rgb[2];
        const float most = rgb[0] > rgb[1] ? rgb[0] : rgb[1];
        const float floor = 0.03f * (most > rgb[2] ? most : rgb[2]);
        return y < floor ? floor : y;
    }
    const std::array<float, 3>& weights() const { return m_weights; }

    /// What the samples are taken as and why, in a few words for people.
    const std::string& description() const { return m_description; }

    /// Makes metadata say which space decoded samples are in: oiio:ColorSpace and, where that is not enough, chromaticities.
    void declare_linear(OIIO::ImageSpec& spec) const;

    /// Name that the configuration of $OCIO, or without one OpenImageIO, has for the space of the samples as stored; empty if
    /// it has none.
    const std::string& config_name() const { return m_config_name; }
    /// Converts `count` RGB triples as stored to the scene-linear space that Colour::resolve() speaks of.
    bool to_scene_linear(float* rgb, std::size_t count) const;

    struct Decoder;

private:
    bool m_converts = false;  ///< the matrices are not the identity
    std::array<float, 9> m_to_rec709 {}, m_from_rec709 {};
    std::array<float, 3> m_weights { 0.2126f, 0.7152f, 0.0722f };
    std::array<int, 3> m_channels { 0, 0, 0 };
    int m_count = 0;
    std::shared_ptr<const Decoder> m_decoder;
    std::string m_linear_name = "Linear";
    std::string m_config_name, m_description;
    std::vector<float> m_chromaticities;  ///< of decoded samples; 8 or, where the name says it all, none

    friend struct ColourFinder;
};

}  // namespace pimg
