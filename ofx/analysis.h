// SPDX-License-Identifier: BSD-3-Clause
// The buttons of HDR Compress: what is found in a frame, and the statistics of a shot as keys of its parameters.
#pragma once

#include <string>
#include <vector>

#include "instance.h"

namespace pimg_ofx {

/// Keys of the options of HDR Compress that are found from the picture when they are 0, as their help says.
std::vector<std::string> found_keys();

/// Answers kOfxActionInstanceChanged. Only parameters that a user has changed have consequences.
OfxStatus instance_changed(Instance& instance, const Properties& in);

/// Writes what is found in the frame at `time` to the parameters that show it. False with a line in `error`, or with none if
/// the user stopped it.
bool show_found(Instance& instance, OfxTime time, std::string& error);

/// Measures every frame of the source and sets keys of dmax, key and white. Frames in which nothing is lit get none, and a
/// message says so. False with a line in `error`, or with none if the user stopped it; then nothing is set.
bool analyse_shot(Instance& instance, std::string& error);

}  // namespace pimg_ofx
