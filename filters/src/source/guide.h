// SPDX-License-Identifier: BSD-3-Clause
// From the samples of a picture to the finite numbers the engine works on: luminance and its logarithm, and the rule
// for samples that have none. The rule is stated in progressive_image.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/channels.h>
#include <pimg/colour.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Guide units of one stop of a log guide: 20 stops are the 255 of an 8-bit picture.
constexpr float kUnitsPerStop = 12.75f;

/// One sample that is not finite.
struct SpecialSample {
    Index pixel;
    int channel;
    float value;
};

/// Replaces the samples at `holes` by the mean of the known ones around them, from the rim of each hole inwards;
/// zero if there are none at all.
void fill_holes(Raster& raster, const std::vector<Index>& holes);

/// Replaces the samples of the colour channels of `picture` (float, local) that are not finite by fill_holes(), and
/// returns what they were.
std::vector<SpecialSample> repair(OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel);

/// How common each magnitude is. Bins are 1/32 of an octave wide on average and taken from the floats' own bits, so
/// scaling a picture by a power of two moves every quantile by exactly that.
class MagnitudeHistogram {
public:
    explicit MagnitudeHistogram(const std::vector<float>& values);  ///< counts the positive finite ones

    /// Value at a quantile, 0..1; 0 if nothing was counted.
    float quantile(double q) const;

private:
    std::vector<std::uint32_t> m_bins;
    std::uint64_t m_count = 0;
};

/// A pixel whose light is not the scene's, and the light it is shown with instead; see ringing.h.
struct FilledPixel {
    Index pixel;
    std::array<float, 3> rgb;  ///< linear
};

/// log2 luminance of every pixel, in guide units, relative to `reference`, a power of two near the middle.
struct LogLuminance {
    Raster guide;
    float reference = 1.0f;           ///< luminance at guide value 0
    float floor = 0.0f;               ///< guide value of everything as dark as black
    std::vector<FilledPixel> filled;  ///< by pixel
};

LogLuminance log_luminance(const OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel);

/// Stored samples as guide channels: each colour channel, or only their weighted sum.
struct StoredGuide {
    std::vector<Raster> channels;
    float scale = 256.0f;  ///< guide units to one unit of the samples, a power of two
    bool clipped = false;  ///< values far above the others were limited
};

/// `whole_numbers`: the samples came from an integer format and are 0..1.
StoredGuide stored_guide(const OIIO::ImageBuf& picture, const Colour& colour, bool separate, bool whole_numbers,
                         const ParallelFor& parallel);

/// Alpha below this, the least normal half, is as good as none: colours are not divided by it.
constexpr float kLeastAlpha = 0x1p-14f;

/// `count` pixels of a float picture from number `first` on (row-major) as linear RGB triples; the first colour channel
/// stands in for missing ones. Colours are straight: where they are associated with alpha, it is divided out.
void linear_pixels(const OIIO::ImageBuf& picture, const Colour& colour, Index first, std::size_t count, float* rgb);

/// Multiplies results made of linear_pixels() by alpha again.
void associate_pixels(const OIIO::ImageBuf& picture, const Colour& colour, Index first, std::size_t count, float* rgb);

}  // namespace PIMG_ABI
}  // namespace pimg
