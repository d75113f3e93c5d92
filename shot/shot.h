// SPDX-License-Identifier: BSD-3-Clause
// The exposure of a shot: what was measured in every frame, and what a frame is rendered with so that nothing flickers.
#pragma once

#include <map>
#include <string>

#include <OpenImageIO/imagebuf.h>

#include <pimg/options.h>

namespace pimg {

/// What fixes the compression of a frame: all else that hdr_compress finds follows from these. 0: to be found, and in
/// the figures of a shot: not measured, since nothing in the frame is lit.
struct Anchors {
    float dmax = 0.0f, key = 0.0f, white = 0.0f;
    float light = 0.0f;  ///< median luminance of what is lit, in the picture's units; it only tells scenes apart

    /// Options that are given stay.
    void apply(HdrCompressOptions& options) const;
};

/// The median luminance of the lit pixels of a picture in the colour space named (empty: see Colour::resolve()), 0 if
/// fewer than one in a thousand are. Fails, with one line in `error`, like Colour::resolve().
bool median_light(const OIIO::ImageBuf& picture, const std::string& space, float& light, std::string& error);

/// Keys of --shot-stats.
struct ShotOptions {
    std::string mode = "smooth";  ///< smooth, lock
    float radius = 3.0f;          ///< of smoothing, in frames
    std::string cuts = "auto";    ///< auto, none, or the first frames of scenes: "25,49"
    bool update = false;          ///< measure though the file is there
    bool render = true;           ///< after that do what the command line says; false: only measure
};

class Shot {
public:
    /// Views of one frame count as one: their mean is taken.
    void add(int frame, const Anchors& anchors) { m_frames.emplace(frame, anchors); }

    bool has(int frame) const { return m_frames.count(frame) > 0; }

    /// What to render a frame with. Every scene of the shot has its own. Frames that are black, in a fade to or from
    /// black, or a flash say nothing of it: they are rendered like the nearest other frame of their scene. It depends on
    /// what is in the file and on nothing else, so any machine can render any frame. smooth: a line fitted to the frames
    /// around, which follows a drift to the very ends of the shot; lock: the shot's mean.
    Anchors anchors(int frame, const ShotOptions& options) const;

    /// Fails, with one line in `error`, if `cuts` is not one of the values above.
    static bool check_cuts(const std::string& cuts, std::string& error);

    bool read(const std::string& filename, std::string& error);
    bool write(const std::string& filename, std::string& error) const;

private:
    /// Frames that say something of the exposure of `frame`, which becomes the nearest of them.
    std::multimap<int, Anchors> frames_of_scene(int& frame, const ShotOptions& options) const;

    std::multimap<int, Anchors> m_frames;  ///< one for each view
};

template<>
const std::vector<Option<ShotOptions>>& option_table<ShotOptions>();

}  // namespace pimg
