// SPDX-License-Identifier: BSD-3-Clause
// OpenImageIO's text formatting, compiled once: its own functions put all of fmt into every file that calls them, which
// is half of the time such a file takes to compile.
#pragma once

#include <string>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/strutil.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What OIIO::Strutil::fmt::format() returns.
PIMG_EXPORT_DETAIL std::string format_packed(fmt::string_view pattern, fmt::format_args arguments);

template<class... Arguments>
std::string format(const char* pattern, const Arguments&... arguments)
{
    return format_packed(pattern, fmt::make_format_args(arguments...));
}

/// The text as a JSON string, in quotation marks; names of files and channels may hold any character.
PIMG_EXPORT_DETAIL std::string quoted_json(const std::string& text);

/// Gives `picture` a message, as its errorfmt() does.
inline void set_error(const OIIO::ImageBuf& picture, const std::string& message)
{
    picture.error(OIIO::string_view(message));
}

/// A message as users see it, for what it quotes may be of any length and hold anything: one line of at most 1500 bytes, the
/// middle left out of it and of every word over 300, line breaks as spaces, other control characters as question marks.
PIMG_EXPORT_DETAIL std::string one_line(const std::string& message);

/// The first line of what OpenImageIO says, which may be several: 3.1 explains what a missing file might be.
inline std::string first_line(const std::string& message)
{
    return one_line(message.substr(0, message.find('\n')));
}

}  // namespace PIMG_ABI
}  // namespace pimg
