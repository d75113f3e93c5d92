// SPDX-License-Identifier: BSD-3-Clause
#include "shot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <vector>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>
#include <pimg/detail/stop.h>

#include "scenes.h"

namespace pimg {

template<>
const std::vector<Option<ShotOptions>>& option_table<ShotOptions>()
{
    using T = ShotOptions;
    static const std::vector<Option<T>> table = {
        { &T::mode,
          { "mode", 0, 0, "", "smooth|lock",
            "smooth: exposure follows slow changes; lock: one exposure for the whole shot" } },
        { &T::radius,
          { "radius", 0.1, 10000, "frames", "", "how many frames before and after a frame mode=smooth looks at" } },
        { &T::cuts,
          { "cuts", 0, 0, "", "", "auto finds cuts; none: one scene; else the first frames of scenes: 25,49" } },
        { &T::update, { "update", 0, 0, "", "", "measure again even if FILE exists, and overwrite it" } },
        { &T::render, { "render", 0, 0, "", "", "0: only measure, write no pictures" } },
    };
    return table;
}

namespace {

struct Member {
    const char* name;
    float Anchors::*value;
};
constexpr Member kMembers[] = { { "dmax", &Anchors::dmax }, { "key", &Anchors::key }, { "white", &Anchors::white } };

/// The figures of a frame: of each member the mean of the logarithms over those of the frame's views in which it was
/// measured. Empty if there are none. Light is first; older files do not have it.
template<class Iterator>
std::vector<double> mean_stops(Iterator first, Iterator last)
{
    std::vector<double> stops;
    for (float Anchors::*member : { &Anchors::light, &Anchors::dmax, &Anchors::key, &Anchors::white }) {
        double sum = 0.0, count = 0.0;
        for (Iterator it = first; it != last; ++it)
            if (const Anchors& a = it->second; a.key > 0.0f) {
                const float value = a.light > 0.0f ? a.*member : a.key;
                sum += std::log2(std::max(double(value), 1e-30));
                count += 1.0;
            }
        if (count == 0.0)
            return {};
        stops.push_back(sum / count);
    }
    return stops;
}

/// A member of the frames fitted at frame number `frame`; 0 if it was measured in none.
float fitted(const std::multimap<int, Anchors>& frames, float Anchors::*member, int frame, const ShotOptions& options)
{
    const bool lock = options.mode == "lock";
    // Weighted least squares on logarithms; x is the distance from the frame asked for.
    double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
    for (const auto& [number, anchors] : frames) {
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

/// False unless every word is a frame's number.
bool parse_cuts(const std::string& text, std::vector<int>& told)
{
    if (text == "auto" || text == "none")
        return true;
    for (const std::string& word : OIIO::Strutil::splits(text, ",")) {
        if (!OIIO::Strutil::string_is_int(word))
            return false;
        told.push_back(OIIO::Strutil::stoi(word));
    }
    return true;
}

}  // namespace

void Anchors::apply(HdrCompressOptions& options) const
{
    for (const auto& [to, from] : { std::pair(&options.dmax, dmax), { &options.key, key }, { &options.white, white } })
        if (*to <= 0.0f)
            *to = from;
}

bool median_light(const OIIO::ImageBuf& picture, const std::string& space, float& light, std::string& error)
{
    constexpr std::size_t kLitOf = 1000;  ///< fewer than one lit pixel in so many are hot pixels
    Colour colour;
    if (!Colour::resolve(picture.nativespec(), space, "", colour, error))
        return false;
    std::vector<float> lit;
    std::vector<float> rgb(3 * std::size_t(picture.spec().width));
    for (OIIO::ROI row = picture.roi(); row.ybegin < picture.yend(); ++row.ybegin) {
        stop_point();
        row.yend = row.ybegin + 1;
        for (int c = 0; c < 3; ++c) {
            row.chbegin = colour.channel(std::min(c, colour.count() - 1));
            row.chend = row.chbegin + 1;
            picture.get_pixels(row, OIIO::TypeFloat, rgb.data() + c, 3 * sizeof(float));
        }
        colour.decode(rgb.data(), rgb.size() / 3);
        for (std::size_t i = 0; i < rgb.size(); i += 3)
            if (const float y = colour.luminance(&rgb[i]); std::isfinite(y) && y > 0.0f)
                lit.push_back(y);
    }
    light = 0.0f;
    if (lit.size() * kLitOf < picture.spec().image_pixels() || lit.empty())
        return true;
    const auto middle = lit.begin() + std::ptrdiff_t(lit.size() / 2);
    std::nth_element(lit.begin(), middle, lit.end());
    light = *middle;
    return true;
}

bool Shot::check_cuts(const std::string& cuts, std::string& error)
{
    std::vector<int> told;
    if (parse_cuts(cuts, told))
        return true;
    error = format("cuts=\"{}\": expected auto, none or the first frames of scenes as in 25,49", cuts);
    return false;
}

std::multimap<int, Anchors> Shot::frames_of_scene(int& frame, const ShotOptions& options) const
{
    std::vector<FrameFigures> figures;
    for (auto it = m_frames.begin(); it != m_frames.end(); it = m_frames.upper_bound(it->first))
        figures.push_back({ it->first, mean_stops(it, m_frames.upper_bound(it->first)) });
    std::vector<int> told;
    parse_cuts(options.cuts, told);
    const std::vector<FrameRole> roles = find_scenes(figures, told, options.cuts == "auto");
    int scene = 0;
    for (std::size_t i = 0; i < roles.size(); ++i)
        if (figures[i].frame <= frame)
            scene = roles[i].scene;
    std::multimap<int, Anchors> result;
    int nearest = frame, least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < roles.size(); ++i) {
        if (!roles[i].steady || roles[i].scene != scene)
            continue;
        const auto [first, last] = m_frames.equal_range(figures[i].frame);
        result.insert(first, last);
        if (const int distance = std::abs(figures[i].frame - frame); distance < least) {
            least = distance;
            nearest = figures[i].frame;
        }
    }
    frame = nearest;
    return result;
}

Anchors Shot::anchors(int frame, const ShotOptions& options) const
{
    const std::multimap<int, Anchors> frames = frames_of_scene(frame, options);
    Anchors result;
    for (const Member& member : kMembers)
        result.*member.value = fitted(frames, member.value, frame, options);
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
            anchors.light = entry.get<float>("light", 0.0f);
            if (!std::isfinite(anchors.light + anchors.dmax + anchors.key + anchors.white))
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
        text += format("{}    {{ \"frame\": {}, \"dmax\": {:.9g}, \"key\": {:.9g}, \"white\": {:.9g}, "
                       "\"light\": {:.9g} }}",
                       separator, number, anchors.dmax, anchors.key, anchors.white, anchors.light);
        separator = ",\n";
    }
    text += "\n  ]\n}\n";
    // Whole or not at all: other machines may be waiting for it.
    if (write_whole_file(filename, text, error))
        return true;
    error = format("cannot write \"{}\"{}", filename, error.empty() ? "" : ": " + error);
    return false;
}

}  // namespace pimg
