// SPDX-License-Identifier: BSD-3-Clause
// The exposure of a shot: what was measured in every frame, and what a frame is rendered with so that nothing flickers.
#pragma once

#include <map>
#include <string>

#include <pimg/options.h>

namespace pimgtool {

/// What fixes the compression of a frame: all else that hdr_compress finds follows from these. 0: to be found.
struct Anchors {
    float dmax = 0.0f, key = 0.0f, white = 0.0f;

    /// Options that are given stay.
    void apply(pimg::HdrCompressOptions& options) const;
};

/// Keys of --shot-stats.
struct ShotOptions {
    std::string mode = "smooth";  ///< smooth, lock
    float radius = 3.0f;          ///< of smoothing, in frames
    bool update = false;          ///< measure though the file is there
    bool render = true;           ///< after that do what the command line says; false: only measure
};

class Shot {
public:
    /// Views of one frame count as one: their mean is taken.
    void add(int frame, const Anchors& anchors) { m_frames.emplace(frame, anchors); }

    bool has(int frame) const { return m_frames.count(frame) > 0; }

    /// What to render a frame with. It depends on what is in the file and on nothing else, so any machine can render
    /// any frame. smooth: a line fitted to the frames around, which follows a drift to the very ends of the shot; lock:
    /// the shot's mean.
    Anchors anchors(int frame, const ShotOptions& options) const;

    bool read(const std::string& filename, std::string& error);
    bool write(const std::string& filename, std::string& error) const;

private:
    float value(float Anchors::*member, int frame, const ShotOptions& options) const;

    std::multimap<int, Anchors> m_frames;  ///< one for each view
};

}  // namespace pimgtool

namespace pimg {

template<>
const std::vector<Option<pimgtool::ShotOptions>>& option_table<pimgtool::ShotOptions>();

}  // namespace pimg
