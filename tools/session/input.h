// SPDX-License-Identifier: BSD-3-Clause
// Reading files: which of their parts, upright, and with the hints that --iconfig gives to readers.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

namespace pimgtool {

/// What `--part` and `--iconfig` say about the files that follow, and what the outputs need.
struct InputOptions {
    std::string part;         ///< number from 0, name, or "all"; empty: all if `keeps_parts`, else the picture
    OIIO::ImageSpec config;   ///< hints for readers
    bool keeps_parts = true;  ///< an output holds several parts
    bool upright = true;      ///< pictures are turned as their metadata ask
};

/// One part of a file.
struct InputPart {
    std::shared_ptr<OIIO::ImageBuf> pixels;
    OIIO::ImageSpec stored;  ///< the header of the part in the file
    int number = 0;          ///< from 0
    bool turned = false;     ///< upright, other than in the file
};

/// What was read: the part that is the picture comes first, the others follow in order.
struct InputFile {
    std::string path;  ///< of the file on disk or in memory, for other readers
    std::vector<InputPart> parts;
    std::string warning;  ///< which parts were not read; "" for none
};

/// Reads a file, or standard input. The picture is the part asked for, else the first that holds a picture. False, with
/// the reason in `error`, if that is not possible.
bool read_file(const std::string& filename, const InputOptions& settings, const std::function<void(float)>& progress,
               InputFile& file, std::string& error);

/// Turns a picture as Orientation of its metadata asks. False with an error in the picture.
bool turn_upright(OIIO::ImageBuf& pixels);

/// What a part is called in messages: its name, else its number.
std::string part_name(const OIIO::ImageSpec& spec, int number);

/// Adds a hint for readers: a whole number, a floating-point number or a word. `type` may name the type, as oiiotool does.
bool add_reader_hint(OIIO::ImageSpec& config, const std::string& name, const std::string& value,
                     const std::string& type, std::string& error);

}  // namespace pimgtool
