// SPDX-License-Identifier: BSD-3-Clause
// .pimg files are read and written by the reader and writer that are linked in, whatever plugin $OIIO_LIBRARY_PATH
// names, because these also hand over hierarchies.
#pragma once

#include <memory>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>
#include <pimg/codec.h>
#include <pimg/progressive_image.h>

namespace pimgtool {

/// The hierarchy in a file, to be read when it is needed.
class StoredHierarchy {
public:
    /// Null if the file has none, or if it is not that of the picture as it was read, whose header is `spec`: a reader
    /// may have multiplied colours by alpha, which makes another hierarchy.
    static std::shared_ptr<StoredHierarchy> open(const std::string& filename, const OIIO::ImageSpec& spec);

    /// `pixels` is the picture in the file.
    bool read(const OIIO::ImageBuf& pixels, const pimg::BuildOptions& options, pimg::ProgressiveImage& image) const;

private:
    explicit StoredHierarchy(const std::string& filename);

    OIIO::Filesystem::IOFile m_proxy;
    pimg::Decoder m_decoder;
};

/// The reader for a file that has the format's signature; null for other files.
std::unique_ptr<OIIO::ImageInput> pimg_input(const std::string& filename);

/// The writer for a file's extension; `hierarchy` is what a .pimg file is to store. Null if there is no writer.
std::unique_ptr<OIIO::ImageOutput> create_output(const std::string& filename,
                                                 const pimg::Hierarchy* hierarchy = nullptr);

bool has_pimg_extension(const std::string& filename);

/// What --info prints: the picture, and chunks and their sizes. False with a line in `text` if the file cannot be read.
bool describe_file(const std::string& filename, std::string& text);

}  // namespace pimgtool
