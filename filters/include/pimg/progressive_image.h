// SPDX-License-Identifier: BSD-3-Clause
// A picture with its hierarchy: built once, filtered many times.
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

/// What building took.
struct BuildStats {
    double read_seconds = 0.0;      ///< copying the picture as float
    double guide_seconds = 0.0;     ///< luminance and logarithm
    double sample_seconds = 0.0;    ///< the initial mesh, if adaptive
    double simplify_seconds = 0.0;  ///< the hierarchy
    std::string guide;              ///< the one used: luma, log, rgb or lab
    SimplifyStats engine;
};

/// A progressive image (Lee, Yoon & Lee 2008): the source pixels, the hierarchy built from their guide, and the
/// bands of the guide. Immutable after build() apart from caches that are safe to fill from several threads; so one
/// object can serve many filters and windows at once. Copies share everything.
///
/// The guide, which decides the mesh, is
///   luma  the weighted sum of the colour samples as stored, 256 units to an integer format's range;
///   rgb   those samples themselves, weighted alike; or
///   log   log2 of the luminance of linear light, 12.75 units to a stop.
/// The engine needs finite numbers. What becomes of samples that have none:
///   NaN, Inf      the mean of the known samples around them, in the copy that is worked on. Filters that return
///                 the picture's own kind of numbers put such a sample back as it was; hdr_compress, which returns
///                 display values, keeps the mean, and white for +Inf.
///   negative      light is not negative: a pixel without luminance has the mean log luminance of those around it.
///   black         a stop below the 0.1 % quantile of the other pixels, but no more than 16 stops below their median.
///   hot pixels    one of the brightest 0.1 % and 10 stops above all its neighbours: their mean.
///   light sources limited to 8 stops above the 99.95 % quantile.
/// The last four concern only the guide; the pixel keeps its ratio to its luminance. All limits are relative to the
/// picture: scaling it by a power of two gives the very same mesh.
///
/// Colour with alpha is worked on as stored, that is associated (premultiplied), like everywhere in OpenImageIO.
class ProgressiveImage {
public:
    /// Gives a hierarchy that was built before and, on it, the bands of channels of one finite value per mesh pixel
    /// each; such as Decoder::read_hierarchy().
    using StoredHierarchy =
        std::function<Status(const std::vector<const float*>& channels, Hierarchy&, std::vector<Bands>&)>;

    ProgressiveImage() = default;

    /// Builds from `src` (any pixel type, data window and channels; not deep, not a volume). nthreads as everywhere in
    /// OpenImageIO: 0 = the "threads" attribute; the result does not depend on it. On failure returns
    /// false and error() says why.
    bool build(const OIIO::ImageBuf& src, const BuildOptions& options = {}, int nthreads = 0, Progress progress = {});

    /// The same with a stored hierarchy of this very picture: nothing is built, and options.base has no effect.
    bool adopt(const OIIO::ImageBuf& src, const StoredHierarchy& stored, const BuildOptions& options = {},
               int nthreads = 0);

    bool initialized() const { return m_data != nullptr; }
    const std::string& error() const { return m_error; }

    /// The following need an initialized() object.
    const Hierarchy& hierarchy() const;
    const std::vector<Bands>& guide_bands() const;  ///< of each channel of the guide
    const OIIO::ImageBuf& source() const;           ///< the picture as float, own memory, NaN and Inf replaced
    const OIIO::ImageSpec& spec() const;            ///< as the picture given had it
    const BuildOptions& options() const;
    const BuildStats& stats() const;
    std::size_t memory() const;  ///< bytes held now, caches included

    struct Data;  ///< what the filters share; see filters/src/progressive_image_data.h
    const std::shared_ptr<Data>& data() const { return m_data; }

private:
    using MakeHierarchy = std::function<bool(Data&, std::string& error)>;
    bool make(const OIIO::ImageBuf& src, const BuildOptions& options, const MakeHierarchy& make_hierarchy);

    std::shared_ptr<Data> m_data;
    std::string m_error;
};

}  // namespace pimg
