// SPDX-License-Identifier: BSD-3-Clause
// Filters on progressive images, in the manner of OpenImageIO's ImageBufAlgo. The rules here hold for all filters. The
// comment of a filter says what it does, and where it differs from these rules. Sections, equations and figures are those
// of the paper of Lee, Yoon and Lee (2008).
//
// Forms     Each filter can be called in four forms. The result goes to `dst`, or is returned. The source is a picture,
//           whose hierarchy is then built with default BuildOptions, or a ProgressiveImage; then the hierarchy is built
//           once, and each further setting costs one sweep:
//               bool     f(ImageBuf& dst, const ImageBuf& src,         const Options& = {}, ROI = {}, int nthreads = 0)
//               bool     f(ImageBuf& dst, const ProgressiveImage& src, const Options& = {}, ROI = {}, int nthreads = 0)
//               ImageBuf f(const ImageBuf& src,                        const Options& = {}, ROI = {}, int nthreads = 0)
//               ImageBuf f(const ProgressiveImage& src,                const Options& = {}, ROI = {}, int nthreads = 0)
//           Options is the struct named where the filter is declared. A filter converts to a pointer to the second
//           form.
// Errors    The dst form returns false and leaves a message in dst.geterror(); the other returns a picture
//           with has_error(). Nothing is thrown. Deep images, volumes, and empty pictures are refused.
// Source    Any pixel type, any number of channels, any data window, in memory or in an ImageCache. It is read as float.
//           It may be `dst`.
// Result    A `dst` that is not initialized gets the windows, channels and metadata of the source, and its pixel type
//           unless stated otherwise ("dst: float"). A `dst` that is initialized keeps its own, and only those of its
//           pixels change that are inside `roi` and inside the source.
// roi       Restricts the pixels and channels that are written. If undefined, all of dst is written, or all of the source
//           if dst is not initialized. The picture is always filtered as a whole, so that the pixels of a region are the
//           same as in the whole result.
// nthreads  0 = OpenImageIO's "threads" attribute. Never changes a bit of the result.
// Channels  Colour channels are filtered: those named R, G and B, else the first three that are neither alpha nor depth
//           (Colour::count()). The others, alpha among them, are copied.
// Alpha     Colour is worked on as stored, that is associated (premultiplied).
// Light     Of scene-linear pictures (pixels that are not whole numbers, in a linear space) no filter makes negative
//           light: a sample is never below min(0, the least sample of its 3 x 3 in the source), and what would
//           undershoot stays above a quarter of the light around.
// NaN, Inf  Filters work on neighbouring values instead (ProgressiveImage), and put such samples back as they were,
//           unless stated otherwise.
// Options   Declared in options.h with their ranges and defaults. Values outside the range, and NaN or Inf, are errors.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/filter_forms.h>
#include <pimg/options.h>
#include <pimg/progressive_image.h>

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

using OIIO::ImageBuf;
using OIIO::ROI;

/// The functions that do the work of the filters below. Call the filters by their names below, in any of the four forms.
namespace on_hierarchy {
PIMG_EXPORT bool hdr_compress(ImageBuf& dst, const ProgressiveImage& src, const HdrCompressOptions& options, ROI roi,
                              int nthreads);
PIMG_EXPORT bool feature_lowpass(ImageBuf& dst, const ProgressiveImage& src, const FeatureLowpassOptions& options,
                                 ROI roi, int nthreads);
PIMG_EXPORT bool detail_enhance(ImageBuf& dst, const ProgressiveImage& src, const DetailEnhanceOptions& options,
                                ROI roi, int nthreads);
PIMG_EXPORT bool level_image(ImageBuf& dst, const ProgressiveImage& src, const LevelOptions& options, ROI roi,
                             int nthreads);
PIMG_EXPORT bool wireframe(ImageBuf& dst, const ProgressiveImage& src, const WireframeOptions& options, ROI roi,
                           int nthreads);
PIMG_EXPORT bool dual_pieces(ImageBuf& dst, const ProgressiveImage& src, const DualPiecesOptions& options, ROI roi,
                             int nthreads);
PIMG_EXPORT bool segment(ImageBuf& dst, const ProgressiveImage& src, const SegmentOptions& options, ROI roi,
                         int nthreads);
PIMG_EXPORT bool paint(ImageBuf& dst, const ProgressiveImage& src, const PaintOptions& options, ROI roi, int nthreads);
PIMG_EXPORT bool mosaic(ImageBuf& dst, const ProgressiveImage& src, const MosaicOptions& options, ROI roi,
                        int nthreads);
PIMG_EXPORT bool ink(ImageBuf& dst, const ProgressiveImage& src, const InkOptions& options, ROI roi, int nthreads);
}  // namespace on_hierarchy

// The forms are objects with names of functions.
// NOLINTBEGIN(readability-identifier-naming)

/// Compresses the range of luminance of a scene to that of a display (section 5.1). This happens in log2 luminance: the
/// base is multiplied by s0, and every detail d by
///     h(d) = s0 + (1 - s0) (1 - d / dmax)^beta,      d = |detail|, at most dmax.
/// This is Eq. (2). As printed (coherence = 0), it makes halos and reverses gradients, because small corrections beside a
/// strong edge are compressed less than the edge. With coherence > 0, both details of a split therefore take h of their
/// contrast envelope instead of their own size. The envelope mixes two contrasts: with the weight `coherence` the envelope
/// of the coarser vertices around, and with the rest of the weight the contrast of the coarser faces they correct, or
/// their own if it is larger. Then exposure and white are fitted to the display, unless fit = 0.
///
/// `fine`, `medium` and `coarse` are stops by which the gain of details is raised, by their size; `shadows`, `midtones`,
/// `highlights` or the curve `zones` raise parts of the picture by how light the scene is there.
///
/// The option `output` says what the result is. dst: float.
///   display  (the default) Linear light for a display, with white at 1, and up to peak / 203 for an HDR display, in the
///            primaries of the source, which oiio:ColorSpace names. Hue and saturation are those of the source. NaN
///            becomes the mean of what is around it, and +Inf white.
///   scene    Scene-linear light, before any mapping to a display: the source times 2^gain. What has a luminance of 0.18
///            keeps it. With `aovs`, the colours of all layers that hold light get the same factor; data, albedo and
///            masks do not.
///   gain     That gain, the base-2 logarithm of the factor, as one channel.
/// 8-bit and other encoded sources are decoded first. With fit = 0 the result is in the units of the decoded source, and
/// s0 = 1 then returns the decoded source.
inline constexpr FilterForms<HdrCompressOptions> hdr_compress { "hdr_compress", on_hierarchy::hdr_compress };

/// Removes texture and keeps features, in one of two ways.
///   strength, noise   (the default) What has little contrast for its size is removed; edges and thin lines stay. All
///                     channels are smoothed together. strength = 0 returns the source, bit for bit.
///   splits, fraction  (section 4.1) The details of all but the first splits are left out, so the picture becomes linear
///                     between the vertices that are left. With all splits kept, the result is the source.
inline constexpr FilterForms<FeatureLowpassOptions> feature_lowpass { "feature_lowpass",
                                                                      on_hierarchy::feature_lowpass };

/// Amplifies details by a factor, in one of three ways.
///   gain, from, to        (section 4.1) Multiplies the details of a range of splits by `gain`.
///   curve                 Multiplies the details of every split by a factor that depends on its position among them.
///   strength, noise, log  Multiplies what feature_lowpass() of that strength removes by `gain`, less on edges, so that
///                         they keep their shape.
/// What is no more than noise is not amplified, unless denoise = 0; texture that covers the whole picture counts as noise.
/// gain = 1 returns the source, bit for bit. dst: floating point, since results may leave the range of the source.
inline constexpr FilterForms<DetailEnhanceOptions> detail_enhance { "detail_enhance", on_hierarchy::detail_enhance };

/// Shows the mesh M_i of one level as a picture: colours are interpolated over its triangles (Gouraud shading). NaN and
/// Inf only come back at the finest level.
inline constexpr FilterForms<LevelOptions> level_image { "level_image", on_hierarchy::level_image };

/// Draws the edges of the mesh M_i of one level in black (0) on white (1). With `overlay`, they are drawn over the result
/// of level_image(): black where that is brighter than its mean, and white elsewhere.
inline constexpr FilterForms<WireframeOptions> wireframe { "wireframe", on_hierarchy::wireframe };

/// Partitions the picture into the dual pieces of one level (section 4.2). The piece of a vertex of M_i consists of the
/// pixels whose vertices were merged into it. A piece is a union of pieces of any finer level, and one of these has its
/// number. The level is chosen as for level_image(); the finest has a piece for every vertex of its mesh, normally for
/// every pixel. The option `output` says what the result holds:
///   labels            one channel of vertex numbers from 0 that are not scaled to any range. dst: uint32.
///   mean, boundaries  as for segment().
inline constexpr FilterForms<DualPiecesOptions> dual_pieces { "dual_pieces", on_hierarchy::dual_pieces };

/// Partitions the picture into regions of similar colour, by merging its pieces, the most similar first (section 4.2).
/// There are exactly `regions` of them, and they are 4-connected. Colours are compared in CIELAB, computed from linear
/// light. A scene-linear picture has no white, so its median luminance is taken as 0.18. The merges are kept with the
/// ProgressiveImage: another number of regions then costs one pass, and coarser regions are unions of finer ones. The
/// option `output` says what the result holds:
///   labels      one channel of region numbers from 0, in the order of the regions' first pixels, row by row; they are
///               not scaled to any range. dst: uint32.
///   mean        every colour channel at its mean over the region, as stored. A NaN or Inf counts as the mean of what is
///               around it.
///   boundaries  one channel: 1 where the right or lower neighbour is in another region, and 0 elsewhere.
/// stats=FILE also writes a table of the regions: area, centre, bounding box, and mean and standard deviation of every
/// channel.
inline constexpr FilterForms<SegmentOptions> segment { "segment", on_hierarchy::segment };

/// Paints the picture with brush strokes (section 5.2), one for every base vertex and for both vertices of every split,
/// from coarse to fine. The dual piece of the vertex gives the place and size of a stroke. Strokes bend along the edges of
/// the picture, and paint ends at them. A stroke that would not bring the canvas closer to the picture is left out. NaN
/// and Inf are painted over. Nothing is clipped. opacity = 0 without a canvas returns the source, bit for bit.
inline constexpr FilterForms<PaintOptions> paint { "paint", on_hierarchy::paint };

/// Makes a mosaic (section 7). Its tiles are the dual pieces of the level with `tiles` vertices, in their mean colour, with
/// joints between them and slopes at their sides. NaN and Inf become the mean of what is around them.
inline constexpr FilterForms<MosaicOptions> mosaic { "mosaic", on_hierarchy::mosaic };

/// Draws the picture in pen and ink (section 7), on white paper: outlines along the features that survive smoothing, and
/// hatching lines or dots that cover as much of the paper as the picture's L* asks for, seen from afar. The first ink is
/// black; more inks are chosen from the colours of the picture's regions. Sizes follow the paper, so that a picture gives
/// nearly the same drawing at any resolution.
inline constexpr FilterForms<InkOptions> ink { "ink", on_hierarchy::ink };

// NOLINTEND(readability-identifier-naming)

/// Replaces every 0 in the options that stands for "found from the picture" by the value that hdr_compress() finds. When
/// all frames of a sequence are rendered with the options of one frame, the sequence does not flicker. For options that
/// are out of range, returns false with one line in `error`.
PIMG_EXPORT bool resolve_hdr_compress(const ProgressiveImage& src, HdrCompressOptions& options, std::string& error,
                                      int nthreads = 0);
/// The same for a plain picture. No hierarchy is built, so this takes little longer than reading the picture. Of `build`,
/// only incolorspace is used.
PIMG_EXPORT bool resolve_hdr_compress(const ImageBuf& src, HdrCompressOptions& options, std::string& error,
                                      const BuildOptions& build = {}, int nthreads = 0);

/// Finds the level that the options ask for. If they ask for more than one, returns false with one line in `error`.
PIMG_EXPORT bool find_level(const Hierarchy& hierarchy, const LevelOptions& options, Level& level, std::string& error);

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
