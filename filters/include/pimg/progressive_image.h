// SPDX-License-Identifier: BSD-3-Clause
// A picture with its hierarchy, which is built once and filtered many times.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/options.h>
#include <pimg/simplify.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What building took, in seconds, and figures of the simplification.
struct BuildStats {
    double read_seconds = 0.0;      ///< copying the picture as float
    double guide_seconds = 0.0;     ///< luminance and logarithm
    double sample_seconds = 0.0;    ///< the initial mesh, if adaptive
    double simplify_seconds = 0.0;  ///< the hierarchy
    std::string guide;              ///< the guide that was used: luma, log, rgb or lab
    std::string wrap;               ///< which sides meet: none, x or xy; see BuildOptions::wrap
    SimplifyStats engine;           ///< of the simplification
};

/// A progressive image (Lee, Yoon & Lee 2008): the pixels of a picture, the hierarchy built from its guide, and the bands
/// of the guide. After build() it does not change, except for caches that several threads may fill at the same time. So
/// one object can serve many filters and threads. Copies share everything.
///
/// The guide, which decides the mesh, is
///   luma  the weighted sum of the colour samples as stored; the range of an integer format has 256 units;
///   rgb   these samples themselves, in the same units;
///   log   log2 of the luminance of linear light; a stop has 12.75 units; or
///   lab   L*, a* and b* of CIELAB.
/// The guide needs finite, plausible numbers. These samples are changed for it:
///   NaN, Inf       They become the mean of the known samples around them, also in the copy that filters work on. Filters
///                  that return the picture's own kind of numbers put such a sample back as it was. hdr_compress, which
///                  returns display values, keeps the mean, and makes +Inf white.
///   negative       Light is not negative. A pixel of negative luminance gets the mean log luminance of those around it.
///   black          Black gets the value a stop below the 0.1 % quantile of the other pixels, but not more than 16 stops
///                  below their median.
///   hot pixels     A pixel that is among the brightest 0.1 %, and 10 stops above all its neighbours, gets their mean.
///   light sources  They are limited to 8 stops above the 99.95 % quantile.
/// The last four concern only the guide `log`; the pixel itself keeps its ratio to its luminance. All limits are relative
/// to the picture: if it is multiplied by a power of two, the mesh stays the same.
///
/// Colour with alpha is worked on as stored, that is associated (premultiplied), as everywhere in OpenImageIO.
///
/// If sides of the picture meet (BuildOptions::wrap), the hierarchy is that of a larger picture, with margins that repeat
/// what is beyond each seam. Filters mix what they make of both margins, so that both sides agree. In panoramas errors
/// count less towards the poles, by the cosine of the latitude.
class PIMG_EXPORT ProgressiveImage {
public:
    /// A function that provides a hierarchy which was built before, and the bands of channels on it. The channels hold one
    /// finite value per mesh pixel each. Decoder::read_hierarchy() (codec.h) does this for files.
    using StoredHierarchy =
        std::function<Status(const std::vector<const float*>& channels, Hierarchy&, std::vector<Bands>&)>;

    ProgressiveImage() = default;

    /// Builds the hierarchy of `src`, which may have any pixel type, data window and channels, but must not be deep or a
    /// volume. nthreads is as everywhere in OpenImageIO: 0 = the "threads" attribute; the result does not depend on it. On
    /// failure, also when `progress` asked to stop, returns false, and error() says why in one line.
    bool build(const OIIO::ImageBuf& src, const BuildOptions& options = {}, int nthreads = 0, Progress progress = {});

    /// The same with a stored hierarchy of this very picture. Nothing is built, so options.base has no effect; except if
    /// sides of the picture meet: stored hierarchies have no margins, so that this is build() then.
    bool adopt(const OIIO::ImageBuf& src, const StoredHierarchy& stored, const BuildOptions& options = {},
               int nthreads = 0);

    /// What a file can store: this, or if sides of the picture meet, the same built without margins. `src` is the picture
    /// this was built from. Not initialized(), with an error(), if building fails or if this is a
    /// preview.
    ProgressiveImage unwrapped(const OIIO::ImageBuf& src, int nthreads = 0) const;

    /// Whether build() or adopt() has succeeded.
    bool initialized() const { return m_data != nullptr; }
    /// Why the last build() or adopt() failed; empty if it did not.
    const std::string& error() const { return m_error; }

    // The following need an initialized() object.

    const Hierarchy& hierarchy() const;             ///< of a preview, that of the reduced picture
    const std::vector<Bands>& guide_bands() const;  ///< of each channel of the guide
    /// The picture as float, own memory, NaN and Inf replaced, with the margins of BuildOptions::wrap: the pixels of the
    /// hierarchy.
    const OIIO::ImageBuf& source() const;
    const OIIO::ImageSpec& spec() const;  ///< the spec of the picture that was given
    const BuildOptions& options() const;  ///< those it was built with
    const BuildStats& stats() const;
    std::size_t memory() const;  ///< bytes held now, caches included

    struct Data;  ///< what the filters share; see filters/src/source/progressive_image_data.h
    const std::shared_ptr<Data>& data() const { return m_data; }

private:
    using MakeHierarchy = std::function<bool(Data&, std::string& error)>;
    bool make(const OIIO::ImageBuf& src, const BuildOptions& options, const MakeHierarchy& make_hierarchy);

    std::shared_ptr<Data> m_data;
    std::string m_error;
};

}  // namespace PIMG_ABI
}  // namespace pimg
