// SPDX-License-Identifier: BSD-3-Clause
// What the reader and the writer share: OpenImageIO's words for a picture and the codec's, and the reader and writer
// themselves for programs that link them in.
#pragma once

#include <exception>
#include <memory>
#include <new>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <pimg/codec.h>
#include <pimg/options.h>
#include <pimg/progressive_image.h>

namespace pimg {
namespace io {

/// How a file is written: keys of `pimg:key` attributes, and of pimgtool's -o.
struct WriteOptions {
    std::string profile = "compact";
    float vertices = kMeshLayerShare;
    int effort = 1;
    int quality = -1;  ///< 0 .. 100 instead of effort; below 0: not given
    int tile = 256;
};

/// The attribute that says that colours are not multiplied by alpha, and the hint that asks for them so.
constexpr const char* kUnassociatedAlpha = "oiio:UnassociatedAlpha";

/// The type samples of an OpenImageIO type are stored as: the same where the format has it, else float.
OIIO::TypeDesc stored_type(const OIIO::TypeDesc& type);
OIIO::TypeDesc type_desc(SampleType type);

/// From the header of a picture to be written, whose types are stored types, and back. Metadata the writer or reader
/// makes itself, hints among it, is left out on both ways.
PictureDesc to_desc(const OIIO::ImageSpec& spec);
OIIO::ImageSpec to_spec(const PictureDesc& desc);

/// Puts the options into a header as the hints a writer looks for.
void add_hints(OIIO::ImageSpec& spec, const WriteOptions& options);

/// Spellings of a number or word a hint may have: 500, 500.0f and "500" are the same.
std::string hint_text(const OIIO::ParamValue& hint);

/// The name of the file itself: without a query, unless there is a file that is literally called so.
std::string file_of(const std::string& name);

/// A writer that stores this hierarchy of the picture instead of building one; nullptr: an ordinary one.
std::unique_ptr<OIIO::ImageOutput> make_output(const Hierarchy* hierarchy);
std::unique_ptr<OIIO::ImageInput> make_input();

/// Runs `body` for a reader or writer of the file `name`: no exception passes OpenImageIO's virtual functions.
template<class File, class Body>
bool guarded(const File& file, const std::string& name, Body&& body)
{
    try {
        return body();
    } catch (const std::bad_alloc&) {
        file.errorfmt("pimg: not enough memory for {}", name);
    } catch (const std::exception& exception) {
        file.errorfmt("pimg: {}", exception.what());
    }
    return false;
}

/// Opens a file within OpenImageIO's limits:channels and limits:imagesize_MB. The proxy must outlive the decoder.
Status open_decoder(OIIO::Filesystem::IOProxy* proxy, Decoder& decoder);

/// The hierarchy in a file, for ProgressiveImage::adopt(). `pixels` is the picture the decoder gives; both must outlive
/// the result.
ProgressiveImage::StoredHierarchy stored_hierarchy(const Decoder& decoder, const OIIO::ImageBuf& pixels);

}  // namespace io

template<>
const std::vector<Option<io::WriteOptions>>& option_table<io::WriteOptions>();

}  // namespace pimg
