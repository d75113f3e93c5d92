// SPDX-License-Identifier: BSD-3-Clause
#include "ops/regions/region_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>

namespace pimg {

namespace {

struct Region {
    double pixels = 0, x = 0, y = 0;
    int xmin = std::numeric_limits<int>::max(), ymin = xmin, xmax = -1, ymax = -1;
    std::vector<double> mean, squares;  ///< per channel; sum of squared differences from the running mean

    explicit Region(std::size_t channels) : mean(channels, 0.0), squares(channels, 0.0) { }

    void add(int px, int py, const float* samples)
    {
        pixels += 1.0;
        x += (px - x) / pixels;
        y += (py - y) / pixels;
        xmin = std::min(xmin, px);
        ymin = std::min(ymin, py);
        xmax = std::max(xmax, px);
        ymax = std::max(ymax, py);
        for (std::size_t c = 0; c < mean.size(); ++c) {
            const double before = double(samples[c]) - mean[c];
            mean[c] += before / pixels;
            squares[c] += before * (double(samples[c]) - mean[c]);
        }
    }
};

std::vector<Region> measure(const OIIO::ImageBuf& picture, const std::vector<Index>& labels, Index regions)
{
    const std::size_t channels = std::size_t(picture.nchannels());
    std::vector<Region> all(regions, Region(channels));
    const float* samples = static_cast<const float*>(picture.localpixels());
    const int width = picture.spec().width;
    for (std::size_t p = 0; p < labels.size(); ++p, samples += channels)
        all[labels[p]].add(int(p % std::size_t(width)), int(p / std::size_t(width)), samples);
    return all;
}

/// Names and values of one record, in order.
using Fields = std::vector<std::pair<std::string, std::string>>;

Fields fields(const OIIO::ImageSpec& spec, Index label, const Region& r)
{
    Fields f = {
        { "label", format("{}", label) },          { "pixels", format("{}", r.pixels) },
        { "x", format("{:.6g}", r.x + spec.x) },   { "y", format("{:.6g}", r.y + spec.y) },
        { "xmin", format("{}", r.xmin + spec.x) }, { "ymin", format("{}", r.ymin + spec.y) },
        { "xmax", format("{}", r.xmax + spec.x) }, { "ymax", format("{}", r.ymax + spec.y) },
    };
    for (std::size_t c = 0; c < r.mean.size(); ++c) {
        const std::string& name = spec.channelnames[c];
        f.emplace_back("mean_" + name, format("{:.9g}", r.mean[c]));
        f.emplace_back("stddev_" + name, format("{:.9g}", std::sqrt(r.squares[c] / r.pixels)));
    }
    return f;
}

/// Channel names may hold any character.
std::string quoted_csv(const std::string& name)
{
    if (name.find_first_of(",\"\n") == std::string::npos)
        return name;
    return '"' + OIIO::Strutil::replace(name, "\"", "\"\"", true) + '"';
}

std::string csv(const Fields& record, bool header)
{
    std::string line;
    for (const auto& [name, value] : record)
        line += (line.empty() ? "" : ",") + (header ? quoted_csv(name) : value);
    return line + "\n";
}

std::string json(const Fields& record)
{
    std::string line;
    for (const auto& [name, value] : record)
        line += (line.empty() ? "  { " : ", ") + quoted_json(name) + ": " + value;
    return line + " }";
}

}  // namespace

bool write_region_report(const OIIO::ImageBuf& picture, const std::vector<Index>& labels, Index regions,
                         const std::string& filename, std::string& error)
{
    const bool as_json = OIIO::Strutil::iends_with(filename, ".json");
    const std::vector<Region> all = measure(picture, labels, regions);
    std::string text = as_json ? "[\n" : "";
    for (Index r = 0; r < regions; ++r) {
        const Fields record = fields(picture.spec(), r, all[r]);
        if (as_json)
            text += json(record) + (r + 1 < regions ? ",\n" : "\n]\n");
        else
            text += (r == 0 ? csv(record, true) : "") + csv(record, false);
    }
    std::string why;
    if (!write_whole_file(filename, text, why)) {
        error = format("stats={}: cannot be written: {}", filename, why);
        return false;
    }
    return true;
}

}  // namespace pimg
