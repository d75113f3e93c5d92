// SPDX-License-Identifier: BSD-3-Clause
// What happens in a shot: cuts, fades, flashes and black frames, told from what was measured in its frames.
#pragma once

#include <vector>

namespace pimg {

/// What was measured in a frame, as logarithms to base 2: first its light, then what else changes from scene to scene.
/// Empty: nothing is lit.
struct FrameFigures {
    int frame = 0;
    std::vector<double> stops;
};

struct FrameRole {
    int scene = 0;        ///< counted from 0; a cut begins the next
    bool steady = false;  ///< its exposure says something of its scene: it is neither black, nor in a fade, nor a flash
};

/// Roles of frames in increasing order. Cuts are found where the median of a figure changes by more than half a stop from
/// the frames before to those after, at once and for good; those `told`, the first frames of scenes, are cuts in any case.
/// `finds_cuts` false: only those told.
std::vector<FrameRole> find_scenes(const std::vector<FrameFigures>& frames, const std::vector<int>& told,
                                   bool finds_cuts);

}  // namespace pimg
