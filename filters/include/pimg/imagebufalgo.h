// SPDX-License-Identifier: BSD-3-Clause
// Filters on progressive images, in the manner of OpenImageIO's ImageBufAlgo. The rules here hold for all functions. The
// comment of a function says what it adds to them and where it differs.
//
// Forms     Each filter can be called in four forms. The result goes to `dst` or is returned; the source is a picture,
//           whose hierarchy is then built with default BuildOptions, or a ProgressiveImage, so that further parameters
//           cost one sweep:
//               bool     f(ImageBuf& dst, const ImageBuf& src,         const Options& = {}, ROI = {}, int nthreads = 0)
//               bool     f(ImageBuf& dst, const ProgressiveImage& src, const Options& = {}, ROI = {}, int nthreads = 0)
//               ImageBuf f(const ImageBuf& src,                        const Options& = {}, ROI = {}, int nthreads = 0)
//               ImageBuf f(const ProgressiveImage& src,                const Options& = {}, ROI = {}, int nthreads = 0)
//           Options is the struct named where the filter is declared. A filter that is given to a function pointer is
//           the second form.
// Errors    The dst form returns false and leaves a message in dst.geterror(); the other returns a picture
//           with has_error(). Nothing is thrown. Deep images, volumes, and empty pictures are refused.
// Source    Any pixel type, any number of channels, any data window; read as float, in memory or in an ImageCache. It
//           may be `dst`.
// Result    A `dst` that is not initialized becomes a copy of the source in windows, channels and metadata, and in pixel
//           type unless stated otherwise. One that is keeps its own, and only pixels inside `roi` and both pictures
//           change.
// roi       Restricts what is written, pixels and channels; undefined = all of dst, or of the source. The picture is
//           always filtered whole, so a region's pixels are those of the whole result.
// nthreads  0 = OpenImageIO's "threads" attribute. Never changes a bit of the result.
// Channels  Colour channels are filtered: R, G, B by name, else the first three that are neither alpha nor
//           depth. The others, alpha among them, are copied.
// Alpha     Colour is worked on as stored, that is associated (premultiplied).
// NaN, Inf  See ProgressiveImage. Filters put such samples back as they were, unless stated otherwise.
// Options   Declared in options.h with range and default; out-of-range or non-finite values are errors.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/filter_forms.h>
#include <pimg/options.h>
#include <pimg/progressive_image.h>

namespace pimg {
namespace ImageBufAlgo {

using OIIO::ImageBuf;
using OIIO::ROI;

/// What the filters below do: on a hierarchy, into `dst`. Call them by the names below.
namespace on_hierarchy {
bool hdr_compress(ImageBuf& dst, const ProgressiveImage& src, const HdrCompressOptions& options, ROI roi, int nthreads);
bool feature_lowpass(ImageBuf& dst, const ProgressiveImage& src, const FeatureLowpassOptions& options, ROI roi,
                     int nthreads);
bool detail_enhance(ImageBuf& dst, const ProgressiveImage& src, const DetailEnhanceOptions& options, ROI roi,
                    int nthreads);
bool level_image(ImageBuf& dst, const ProgressiveImage& src, const LevelOptions& options, ROI roi, int nthreads);
bool wireframe(ImageBuf& dst, const ProgressiveImage& src, const WireframeOptions& options, ROI roi, int nthreads);
bool dual_pieces(ImageBuf& dst, const ProgressiveImage& src, const DualPiecesOptions& options, ROI roi, int nthreads);
bool segment(ImageBuf& dst, const ProgressiveImage& src, const SegmentOptions& options, ROI roi, int nthreads);
bool paint(ImageBuf& dst, const ProgressiveImage& src, const PaintOptions& options, ROI roi, int nthreads);
bool mosaic(ImageBuf& dst, const ProgressiveImage& src, const MosaicOptions& options, ROI roi, int nthreads);
bool ink(ImageBuf& dst, const ProgressiveImage& src, const InkOptions& options, ROI roi, int nthreads);
}  // namespace on_hierarchy

// The forms are objects with names of functions.
// NOLINTBEGIN(readability-identifier-naming)

/// Compresses a scene's range of luminance to a display's (paper, section 5.1). In log2 luminance the base is scaled by
/// s0, and every detail d by
///     h(d) = s0 + (1 - s0) (1 - d / dmax)^beta,      d = |detail|, at most dmax.
/// With coherence > 0 both details of a split take h of their contrast envelope instead: coherence times the envelope
/// of the coarser vertices around, and for the rest the contrast of the coarser faces they correct, or their own if
/// larger. That keeps small corrections beside a strong edge in step with the edge, which Eq. (2) as printed (coherence
/// = 0) does not: it makes halos and reverses gradients. Then exposure and white are fitted to the display, unless fit
/// = 0.
///
/// Returns display-linear RGB, 0..1, in the source's primaries (oiio:ColorSpace says which): linear light, white at 1.
/// Hue and saturation are those of the source. 8-bit and other encoded sources are decoded first. NaN becomes what is
/// around it, +Inf white. With fit = 0 the result is in the units of the (decoded) source, and s0 = 1 returns the
/// source. dst: float.
inline constexpr FilterForms<HdrCompressOptions> hdr_compress { "hdr_compress", on_hierarchy::hdr_compress };

/// Smooths texture away and keeps features. By strength (the default): what is small in contrast for its size goes,
/// edges and thin lines stay; one decision for all channels. strength = 0: the source, bit for bit. By splits or
/// fraction (paper, section 4.1): leaves out the details of all but the first splits, so that what is between them
/// becomes linear. All splits kept: the source.
inline constexpr FilterForms<FeatureLowpassOptions> feature_lowpass { "feature_lowpass",
                                                                      on_hierarchy::feature_lowpass };

/// Multiplies details by `gain`: those of a range of splits (paper, section 4.1), by a curve over the position in the
/// hierarchy, or, with strength, noise or log, what feature_lowpass() of that strength removes, less on edges so that
/// they keep their shape. gain = 1: the source, bit for bit. dst: floating point; results may exceed the source's
/// range.
inline constexpr FilterForms<DetailEnhanceOptions> detail_enhance { "detail_enhance", on_hierarchy::detail_enhance };

/// The mesh M_i of one level as a picture: its triangles, Gouraud-shaded. NaN and Inf only come back at the finest
/// level.
inline constexpr FilterForms<LevelOptions> level_image { "level_image", on_hierarchy::level_image };

/// The edges of the mesh M_i, black on white (1), or with overlay drawn over level_image(): black where
/// that is brighter than its mean, else white.
inline constexpr FilterForms<WireframeOptions> wireframe { "wireframe", on_hierarchy::wireframe };

/// Partitions the picture into the dual pieces of one level (paper, section 4.2): the pixels whose vertices were merged
/// into each vertex of M_i. A piece is a union of pieces at every finer level, where one of them keeps its number.
///   labels      one channel of vertex numbers from 0, not scaled to any range. dst: uint32.
///   mean, boundaries  as for segment().
/// Levels count as in level_image(); the finest has a piece for every pixel.
inline constexpr FilterForms<DualPiecesOptions> dual_pieces { "dual_pieces", on_hierarchy::dual_pieces };

/// Partitions the picture into connected regions that look alike, by merging its pieces, most alike first (paper,
/// section 4.2). Colours are compared in CIELAB: of linear light, with the median luminance at 0.18 if the picture is
/// scene-linear and so has no white. The merges are kept with the ProgressiveImage: other numbers of regions cost one
/// pass, and coarser regions are unions of finer ones. Exactly `regions` of them, 4-connected.
/// labels      one channel of region numbers from 0, in order of their first pixel, row by row, not scaled to any
/// range. dst: uint32.
/// mean        every colour channel at its mean over the region, as stored; special samples count as what is around
/// them.
///   boundaries  one channel, 1 where the right or lower neighbour is in another region, else 0.
/// stats=FILE writes area, centre, bounding box, and mean and deviation of every channel, for each region.
inline constexpr FilterForms<SegmentOptions> segment { "segment", on_hierarchy::segment };

/// Paints the picture with brush strokes (paper, section 5.2): one for every base vertex and for both vertices of every
/// split, from coarse to fine, placed and sized by their dual pieces, bent along the edges, and left out where they
/// would not bring the canvas closer to the picture. Paint ends at the picture's edges. NaN and Inf are painted over.
/// opacity = 0 on the picture's own canvas: the source, bit for bit. Nothing is clipped.
inline constexpr FilterForms<PaintOptions> paint { "paint", on_hierarchy::paint };

/// Lays the dual pieces of the level with that many vertices as tiles of their mean colour, with joints and bevels.
/// NaN and Inf become what is around them.
inline constexpr FilterForms<MosaicOptions> mosaic { "mosaic", on_hierarchy::mosaic };

/// Draws the picture with black lines (0) on white paper (1): along the edges, as dense as it is dark.
inline constexpr FilterForms<InkOptions> ink { "ink", on_hierarchy::ink };

// NOLINTEND(readability-identifier-naming)

/// The options with every value that hdr_compress would find from the picture written in. A sequence
/// rendered with those of one frame does not flicker. False, with an error, for bad options.
bool resolve_hdr_compress(const ProgressiveImage& src, HdrCompressOptions& options, std::string& error,
                          int nthreads = 0);
/// The same without a hierarchy, which takes little longer than reading the picture. Of `build` only the colour space
/// counts.
bool resolve_hdr_compress(const ImageBuf& src, HdrCompressOptions& options, std::string& error,
                          const BuildOptions& build = {}, int nthreads = 0);

/// The level the options ask for. False, with an error, if they ask for several.
bool find_level(const Hierarchy& hierarchy, const LevelOptions& options, Level& level, std::string& error);

}  // namespace ImageBufAlgo
}  // namespace pimg
