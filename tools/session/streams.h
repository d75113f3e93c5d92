// SPDX-License-Identifier: BSD-3-Clause
// Standard input and output as files: "-" or "-.EXTENSION", which names the format.
#pragma once

#include <string>

namespace pimgtool {

/// Whether a name stands for standard input or output. A query may follow, as in "-.pimg?level=100".
bool is_stream(const std::string& filename);

/// Reads standard input to its end, at the first call, and gives the name of a file in memory that holds it and lives as
/// long as the process. Formats are then known by their first bytes. False, with a line in `error`, if it cannot be read
/// or is empty.
bool standard_input(std::string& filename, std::string& error);

/// False, with a line in `error`, if standard output is no place for a picture.
bool can_write_standard_output(std::string& error);

/// A name for a temporary file with the extension of `filename`, to be written before it is sent.
std::string scratch_name(const std::string& filename);

/// Writes all bytes of a file to standard output. False, with a line in `error`, if not all of them arrive.
bool send_to_standard_output(const std::string& filename, std::string& error);

}  // namespace pimgtool
