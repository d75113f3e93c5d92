// SPDX-License-Identifier: BSD-3-Clause
#include "texts.h"

#include <stdexcept>

namespace pimg {
namespace python {

namespace {

template<class Text, std::size_t Count>
const Text& find(const Text (&texts)[Count], const std::string& name)
{
    for (const Text& text : texts)
        if (text.name == name)
            return text;
    throw std::logic_error("no text for " + name);
}

const ArgumentText kArguments[] = {
    { "roi", "None", R"(roi : OpenImageIO.ROI or (xbegin, xend, ybegin, yend)
    only this part is made; its pixels are the same as in the whole result
)" },
    { "nthreads", "0", R"(nthreads : int, default 0
    number of threads; 0: OpenImageIO's attribute "threads". Never changes a result
)" },
    { "progress", "None", R"(progress : callable
    called now and then with the share of the work done, 0 to 1; an exception in it stops the work
)" },
    { "array", "False", R"(array : bool, default False
    return NumPy arrays instead of OpenImageIO.ImageBuf objects
)" },
};

const char* const kFilterErrors = R"(ValueError
    if an option is out of range or the picture cannot be filtered
TypeError
    if a keyword is unknown or the source is of another type
)";

const FunctionText kFunctions[] = {
    { "build",
      R"(Builds the hierarchy of a picture (paper, section 3). Each filter then takes only one sweep over it.

The source is an OpenImageIO.ImageBuf, or a NumPy array of shape (height, width) or
(height, width, channels). It is copied, and results are of the same type. The GIL is released.)",
      { "progress", "nthreads" },
      "ProgressiveImage",
      kFilterErrors },
    { "open",
      R"(Reads a picture from any file OpenImageIO knows.

A .pimg file of the full profile contains its hierarchy, which is used unless options ask for another one.
For all other files the hierarchy is built. The GIL is released.)",
      { "array", "progress", "nthreads" },
      "ProgressiveImage",
      R"(OSError
    if the file cannot be read
)" },
    { "save",
      R"(Writes a .pimg file: the picture without loss, and its hierarchy, so that open() need not build it.)",
      {},
      "None",
      R"(OSError
    if the file cannot be written; nothing is left behind
)" },
    { "resolve_hdr_compress",
      R"(Returns the options of hdr_compress(), with those values that it finds from the picture filled in.

When all frames of a shot are made with the values of one frame, the shot does not flicker.)",
      { "nthreads" },
      "dict",
      kFilterErrors },
    { "gain_map_jpeg",
      R"(A JPEG file that shows its base on SDR displays and an HDR rendition on HDR displays (ISO 21496-1).

base is an ordinary JPEG file, whole, as bytes; its pixels stay as they are. rendition is the HDR picture,
display-linear with the white of SDR at 1, as large as the base: an OpenImageIO.ImageBuf or an array. The
GIL is released.)",
      {},
      "bytes",
      R"(ValueError
    if the base is no JPEG file, has a gain map already or differs in size, or an option is out of range
)" },
    { "hdr_compress",
      R"(Compresses the range of luminance of a scene to that of a display (paper, section 5.1).

Without options, everything is found from the picture. So is an option of value 0 whose text says "found".)",
      { "roi", "nthreads" },
      R"(Linear light for a display, float, white at 1; srgb_encoded() encodes it for a screen or an 8-bit file.
With fit=False the result is in the units of the source.)",
      kFilterErrors },
    { "feature_lowpass",
      R"(Removes texture, and keeps edges and thin lines.

It is controlled by strength or noise, or by splits or fraction (paper, section 4.1). If none of them is
given, strength is 0.03, or 0.3 stops with log.)",
      { "roi", "nthreads" },
      "Like the source. strength=0 returns the source, bit for bit.",
      kFilterErrors },
    { "detail_enhance",
      R"(Amplifies details by the factor gain.

These are the details of a range of vertex splits (paper, section 4.1) or, with strength, noise or log, what
feature_lowpass() of that strength removes.)",
      { "roi", "nthreads" },
      R"(Like the source. Whole numbers become floats, whose range is 0 to 1. Results may leave the range of the
source. gain=1 returns the source, bit for bit.)",
      kFilterErrors },
    { "dual_pieces",
      R"(Partitions the picture into the dual pieces of one level, the finest by default (paper, section 4.2).

A piece is a union of pieces of any finer level, and one of these has its number.)",
      { "roi", "nthreads" },
      R"(labels: uint32 numbers from 0, one channel; mean: like the source; boundaries: one channel, 1 or 0.)",
      kFilterErrors },
    { "segment",
      R"(Partitions the picture into connected regions of similar colour (paper, section 4.2).

For the same ProgressiveImage, another number of regions takes one pass, and the regions are nested.)",
      { "roi", "nthreads" },
      R"(labels: uint32 numbers from 0, one channel; mean: like the source; boundaries: one channel, 1 or 0.)",
      kFilterErrors },
    { "paint",
      R"(Paints the picture with brush strokes that follow its forms (paper, section 5.2).

Options that are None come from the style.)",
      { "roi", "nthreads" },
      "Like the source.",
      kFilterErrors },
    { "mosaic",
      R"(Makes a mosaic whose tiles are the dual pieces of a level, or cells grown from them, in their mean colour (paper, section 7).)",
      { "roi", "nthreads" },
      "Like the source.",
      kFilterErrors },
    { "ink",
      R"(Draws the picture in pen and ink on white paper: outlines, and hatching or dots as dark as the picture (paper, section 7).)",
      { "roi", "nthreads" },
      "Like the source. With one ink, the colour channels are equal.",
      kFilterErrors },
    { "level",
      R"(Shows the mesh M_i of one level as a picture: its triangles, Gouraud-shaded.

At most one option chooses the level. Without options it is the finest.)",
      { "roi", "nthreads" },
      "Like the source.",
      kFilterErrors },
    { "wireframe",
      R"(Draws the edges of the mesh M_i of one level, black on white or, with overlay, over its picture.)",
      { "roi", "nthreads" },
      "Like the source.",
      kFilterErrors },
};

}  // namespace

const char* const kSourceText = R"(

The source is a ProgressiveImage, an OpenImageIO.ImageBuf, or a NumPy array of shape (height, width) or
(height, width, channels): uint8 or uint16 (taken as sRGB), float16, float32 or float64 (linear light of any
range). The result is of the same type. If the source is a plain picture, its hierarchy is built first; to make
several results of one picture, build() it once. The GIL is released.)";

const ArgumentText& argument_text(const std::string& name)
{
    return find(kArguments, name);
}

const FunctionText& function_text(const std::string& name)
{
    return find(kFunctions, name);
}

}  // namespace python
}  // namespace pimg
