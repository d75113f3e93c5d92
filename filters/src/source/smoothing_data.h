// SPDX-License-Identifier: BSD-3-Clause
// What the filters that work by strength need of a picture: its colour channels, as stored or their logarithms, ready
// for core's smooth() and enhance().
#pragma once

#include <string>

#include <OpenImageIO/imagebuf.h>

#include <pimg/options.h>
#include <pimg/progressive_image.h>
#include <pimg/smoothing.h>

#include "source/guide.h"

namespace pimg {
inline namespace PIMG_ABI {

/// A logarithm for samples of either sign: in octaves, log2(x / unit) far above the unit and linear below it. 2^-10 of
/// the picture's median magnitude is the unit: what is darker has no contrast worth keeping.
class SignedLog {
public:
    SignedLog() = default;
    explicit SignedLog(float unit) : m_unit(unit) { }
    void to_log(float* values, std::size_t count) const;
    void from_log(float* values, std::size_t count) const;

private:
    float m_unit = 1.0f;
};

/// The colour channels in the form that core smooths. The samples of the picture are those here times 2^exponent, or
/// from_log() of those here.
struct SmoothingData {
    SmoothingSource source;
    bool log = false;
    SignedLog scale;
    int exponent = 0;
    float noise = 0.0f;  ///< see noise_level()
};

/// The colour channels of the source, as they are.
Channels source_channels(const ProgressiveImage::Data& data);

SmoothingData prepare_smoothing(const ProgressiveImage::Data& data, bool log);

/// The log luminance of a picture without texture, up to about a stop of it, in guide units: a raster of the picture's
/// size. Edges of what is larger stay where they are.
std::vector<float> without_texture(const Hierarchy& hierarchy, const LogLuminance& luminance,
                                   const ParallelFor& parallel);

/// The strength the options ask for, in units of `smoothing`; the default if they do not say.
float find_strength(const StrengthOptions& options, const SmoothingData& smoothing);

/// Converts results of core to rasters of the picture's size, in the picture's units.
void to_picture(const Hierarchy& hierarchy, const SmoothingData& smoothing, Channels& results);

}  // namespace PIMG_ABI
}  // namespace pimg
