// SPDX-License-Identifier: BSD-3-Clause
#include "session/shot.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>

namespace pimg {

template<>
const std::vector<Option<pimgtool::ShotOptions>>& option_table<pimgtool::ShotOptions>()
{
    using T = pimgtool::ShotOptions;
    static const std::vector<Option<T>> table = {
        { &T::mode,
          { "mode", 0, 0, "", "smooth|lock",
            "smooth: exposure follows slow changes; lock: one exposure for the whole shot" } },
        { &T::radius,
          { "radius", 0.1, 10000, "frames", "", "how many frames before and after a frame mode=smooth looks at" } },
        { &T::update, { "update", 0, 0, "", "", "measure again even if FILE exists, and overwrite it" } },
        { &T::render, { "render", 0, 0, "", "", "0: only measure, write no pictures" } },
    };
    return table;
}

}  // namespace pimg

namespace pimgtool {

namespace {

using pimg::format;

struct Member {
    const char* name;
    float Anchors::*value;
};
constexpr Member kMembers[] = { { "dmax", &Anchors::dmax }, { "key", &Anchors::key }, { "white", &Anchors::white } };

}  // namespace

void Anchors::apply(pimg::HdrCompressOptions& options) const
{
    for (const auto& [to, from] : { std::pair(&options.dmax, dmax), { &options.key, key }, { &options.white, white } })
        if (*to <= 0.0f)
            *to = from;
}

float Shot::value(float Anchors::*member, int frame, const ShotOptions& options) const
{
    const bool lock = options.mode == "lock";
    // Weighted least squares on logarithms; x is the distance from the frame asked for.
    double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
    for (const auto& [number, anchors] : m_frames) {
        if (!(anchors.*member > 0.0f))
            continue;
        const double x = lock ? 0.0 : (double(number) - frame) / double(options.radius);
        const double weight = std::exp(-0.5 * x * x), y = std::log2(double(anchors.*member));
        w += weight, wx += weight * x, wxx += weight * x * x, wy += weight * y, wxy += weight * x * y;
    }
    if (w == 0.0)
        return 0.0f;
    const double spread = w * wxx - wx * wx;
    return float(std::exp2(spread > 1e-6 * w * w ? (wxx * wy - wx * wxy) / spread : wy / w));
}

Anchors Shot::anchors(int frame, const ShotOptions& options) const
{
    Anchors result;
    for (const Member& member : kMembers)
        result.*member.value = value(member.value, frame, options);
    return result;
}

bool Shot::read(const std::string& filename, std::string& error)
{
    namespace json = boost::property_tree;
    try {
        json::ptree tree;
        std::ifstream file(filename);
        json::read_json(file, tree);
        for (const auto& [name, entry] : tree.get_child("frames")) {
            Anchors anchors;
            for (const Member& member : kMembers)
                anchors.*member.value = entry.get<float>(member.name);
            if (!std::isfinite(anchors.dmax + anchors.key + anchors.white))
                throw json::ptree_error("a number is not finite");
            add(entry.get<int>("frame"), anchors);
        }
    } catch (const json::ptree_error& e) {
        error = format("cannot read \"{}\": expected figures of a shot as --shot-stats writes them: {}", filename,
                       e.what());
        return false;
    }
    return true;
}

bool Shot::write(const std::string& filename, std::string& error) const
{
    std::string text = "{\n  \"frames\": [";
    const char* separator = "\n";
    for (const auto& [number, anchors] : m_frames) {
        text += format("{}    {{ \"frame\": {}, \"dmax\": {:.9g}, \"key\": {:.9g}, \"white\": {:.9g} }}", separator,
                       number, anchors.dmax, anchors.key, anchors.white);
        separator = ",\n";
    }
    text += "\n  ]\n}\n";
    // Whole or not at all: other machines may be waiting for it.
    if (pimg::write_whole_file(filename, text, error))
        return true;
    error = format("cannot write \"{}\"{}", filename, error.empty() ? "" : ": " + error);
    return false;
}

}  // namespace pimgtool
