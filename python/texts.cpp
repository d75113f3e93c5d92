// SPDX-License-Identifier: BSD-3-Clause
#include "texts.h"

#include <stdexcept>

namespace pimg {
namespace python {

namespace {

template<class Text, std::size_t count>
const Text& find(const Text (&texts)[count], const std::string& name)
{
    for (const Text& text : texts)
        if (text.name == name)
            return text;
    throw std::logic_error("no text for " + name);
}

const ArgumentText kArguments[] = {
    { "roi", "None", R"(roi : OpenImageIO.ROI or (xbegin, xend, ybegin, yend)
    only this part is made, just as it is in the whole result
)" },
    { "nthreads", "0", R"(nthreads : int, default 0
    threads to use; 0: OpenImageIO's attribute "threads". Never changes a result
)" },
    { "progress", "None", R"(progress : callable
    called now and then with the share done, 0 to 1; an exception stops the work
)" },
    { "array", "False", R"(array : bool, default False
    results are NumPy arrays instead of OpenImageIO.ImageBuf
)" },
};

const char* const kFilterErrors = R"(ValueError
    for an option out of range or a picture that cannot be filtered
TypeError
    for an unknown keyword or another kind of source
)";

const FunctionText kFunctions[] = {
    { "build",
      R"(Builds the hierarchy of a picture, on which every filter then takes one sweep (paper, section 3).

The source is an OpenImageIO.ImageBuf, or a NumPy array of shape (height, width) or
(height, width, channels). It is copied; results will be of the same kind. The GIL is released.)",
      { "progress", "nthreads" },
      "ProgressiveImage",
      kFilterErrors },
    { "open",
      R"(Reads a picture from any file OpenImageIO knows.

A .pimg file of the full profile brings its hierarchy, unless options ask for another; else it is built.
The GIL is released.)",
      { "array", "progress", "nthreads" },
      "ProgressiveImage",
      R"(OSError
    if the file cannot be read
)" },
    { "save",
      R"(Writes a .pimg file: the picture, exactly, and the hierarchy, so that open() need not build it.)",
      {},
      "None",
      R"(OSError
    if the file cannot be written; nothing is left behind
)" },
    { "resolve_hdr_compress",
      R"(The options of hdr_compress() with every value it finds from the picture written in.

The frames of a shot made with those of one frame do not flicker.)",
      { "nthreads" },
      "dict",
      kFilterErrors },
    { "hdr_compress",
      R"(Compresses a scene's range of luminance to a display's (paper, section 5.1).

Without options everything is found from the picture; 0 stands for that where it is said so.)",
      { "roi", "nthreads" },
      R"(Display-linear light, float, white at 1; srgb_encoded() makes it fit for a screen or an 8-bit file.
With fit=False in the units of the source.)",
      kFilterErrors },
    { "feature_lowpass",
      R"(Smooths texture away and keeps edges and thin lines.

By strength, or by splits or fraction (paper, section 4.1); none of them means strength=0.03, or 0.3 stops
with log.)",
      { "roi", "nthreads" },
      "As the source; strength=0 is the source, bit for bit.",
      kFilterErrors },
    { "detail_enhance",
      R"(Multiplies details.

Those of a range of splits (paper, section 4.1) or, with strength, noise or log, what feature_lowpass() of
that strength removes.)",
      { "roi", "nthreads" },
      R"(As the source, but float for whole numbers, which are 0 to 1 then; may exceed that range. gain=1 is the
source, bit for bit.)",
      kFilterErrors },
    { "dual_pieces",
      R"(Partitions the picture into the dual pieces of one level, the finest by default (paper, section 4.2).

A piece is a union of pieces at every finer level, where one of them keeps its number.)",
      { "roi", "nthreads" },
      R"(labels: uint32 numbers from 0, one channel; mean: as the source; boundaries: one channel, 1 or 0.)",
      kFilterErrors },
    { "segment",
      R"(Partitions the picture into connected regions that look alike (paper, section 4.2).

Other numbers of regions of the same ProgressiveImage are nested and cost one pass.)",
      { "roi", "nthreads" },
      R"(labels: uint32 numbers from 0, one channel; mean: as the source; boundaries: one channel, 1 or 0.)",
      kFilterErrors },
    { "paint",
      R"(Paints the picture with brush strokes that follow its forms (paper, section 5.2).)",
      { "roi", "nthreads" },
      "As the source.",
      kFilterErrors },
    { "mosaic",
      R"(Lays the dual pieces of a level as tiles of their mean colour (paper, section 7).)",
      { "roi", "nthreads" },
      "As the source.",
      kFilterErrors },
    { "ink",
      R"(Draws with black lines (0) on white paper (1) along the edges (paper, section 7).)",
      { "roi", "nthreads" },
      "As the source, every colour channel the same.",
      kFilterErrors },
    { "level",
      R"(The mesh M_i of one level as a picture: its triangles, Gouraud-shaded.

At most one option; none means the finest level.)",
      { "roi", "nthreads" },
      "As the source.",
      kFilterErrors },
    { "wireframe",
      R"(The edges of the mesh M_i, black on white or, with overlay, on the picture of the level.)",
      { "roi", "nthreads" },
      "As the source.",
      kFilterErrors },
};

}  // namespace

const char* const kSourceText = R"(

The source is a ProgressiveImage, an OpenImageIO.ImageBuf, or a NumPy array of shape (height, width) or
(height, width, channels): uint8 or uint16 (taken as sRGB), float16, float32 or float64 (linear light of any
range). The result is of the same kind. A picture's hierarchy is built on the way: for more than one
result, build() it once. The GIL is released.)";

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
