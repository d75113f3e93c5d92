// SPDX-License-Identifier: BSD-3-Clause
// What is measured on.
#pragma once

#include <vector>

#include <OpenImageIO/imagebuf.h>

namespace bench {

/// A size x size linear RGB picture of some sixteen stops: the file $PIMG_BENCH_PICTURE, repeated as in
/// mirrors to fill the square, or a synthetic landscape when that is not set. The texture per pixel does not
/// depend on the size, so that times per pixel compare.
const OIIO::ImageBuf& picture(int size);

/// Its log luminance stretched to 0..255, row-major: a guide for the engine.
const std::vector<float>& guide(int size);

}  // namespace bench
