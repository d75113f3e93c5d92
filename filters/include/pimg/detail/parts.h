// SPDX-License-Identifier: BSD-3-Clause
// Files of several parts, such as multi-part OpenEXR files and TIFF files of several pages: "subimages" in OpenImageIO.
#pragma once

#include <string>

#include <OpenImageIO/imageio.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Whether a part of a file holds a picture, rather than data such as depth, normals or IDs, as its name
/// (oiio:subimagename) and the names and types of its channels say. Deep parts hold none. `layer` is as in BuildOptions:
/// if it is not empty, only parts that have this layer hold a picture.
PIMG_EXPORT_DETAIL bool holds_picture(const OIIO::ImageSpec& part, const std::string& layer);

}  // namespace PIMG_ABI
}  // namespace pimg
