// SPDX-License-Identifier: BSD-3-Clause
// Writing pictures: formats are checked before any work, files appear whole or not at all, and linear light is
// encoded for formats of whole numbers.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <pimg/hierarchy.h>

#include "pimg_pvt.h"

namespace pimgtool {

/// Pixel types of a file: that of all channels, or one per channel where they differ.
struct PixelTypes {
    OIIO::TypeDesc all;
    std::vector<OIIO::TypeDesc> per_channel;
};

/// What `-d` and `--raw` say about the files that follow.
struct OutputOptions {
    OIIO::TypeDesc type;                                  ///< UNKNOWN: as the input was stored
    std::map<std::string, OIIO::TypeDesc> channel_types;  ///< of channels, or of all of a layer, by name
    bool raw = false;                                     ///< numbers are written as they are
};

/// What a file is to be written from.
struct OutputPicture {
    const OIIO::ImageBuf& pixels;
    PixelTypes types;  ///< wanted; the format may know better
    bool encode_srgb;  ///< encode for display if the format stores whole numbers
    bool labels;       ///< uint32 numbers, to be stored as they are; type UNKNOWN: as the format holds them best
    const pimg::Hierarchy* hierarchy = nullptr;  ///< of `pixels`, for a .pimg file
    pimg::io::WriteOptions options = {};         ///< of a .pimg file
    std::string layer = {};                      ///< the picture, for formats that hold nothing else; see BuildOptions
    std::string part = {};                       ///< the name of the part, for messages
    /// Changes the bytes of the file before it is kept; not for .pimg files.
    std::function<bool(std::string& bytes, std::string& error)> finish = {};
    bool is_gain = false;      ///< numbers with sign and fractions, which the format must keep
    bool is_straight = false;  ///< colours are to be multiplied by alpha where the format wants that
};

/// What there is to say of a file: a few words on what was written, what is not as asked ("" for nothing), and the line
/// that says why it was not written.
struct OutputReport {
    std::string &summary, &warning, &error;
};

/// The type `-d` may be given, UNKNOWN for any other word.
OIIO::TypeDesc output_type(const std::string& word);
extern const char* const kOutputTypes;  ///< the words, for help and messages

/// False, with a line saying why, if a file of that name cannot be written: no writer for its extension, no such
/// directory, a directory, a terminal.
bool can_write(const std::string& filename, std::string& error);

/// Whether files of that format hold several parts.
bool holds_parts(const std::string& filename);

/// Writes the parts of a file, of which `picture` is the one for formats that hold no more. A file is written to a
/// temporary name beside `filename` and renamed when all is written; what goes to standard output is sent when all is
/// written. Formats without names of channels get the picture and its alpha.
bool write_parts(const std::vector<OutputPicture>& parts, std::size_t picture, const std::string& filename,
                 const std::function<void(float)>& progress, const OutputReport& report);

/// The same for a single picture.
bool write_picture(const OutputPicture& picture, const std::string& filename,
                   const std::function<void(float)>& progress, const OutputReport& report);

}  // namespace pimgtool
