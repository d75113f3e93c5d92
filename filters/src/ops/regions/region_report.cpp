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
inline namespace PIMG_ABI {

namespace {

/// Where sides meet, a place is shown again a period further on; that which is nearest to `middle`.
int nearest(int at, double middle, bool meets, int period)
{
    if (!meets)
        return at;
    return at + int(std::lround((middle - at) / period)) * period;
}

struct Region {
    double pixels = 0, x = 0, y = 0;
    int xmin = std::numeric_limits<int>::max(), ymin = xmin, xmax = -1, ymax = -1;
    std::vector<double> mean, squares;  ///< per channel; sum of squared differences from the running mean

    explicit Region(std::size_t channels) : mean(channels, 0.0), squares(channels, 0.0) { }

    void add(int px, int py, const float* samples, const Wrap& wrap)
    {
        if (pixels > 0.0) {
            px = nearest(px, x, wrap.x, wrap.width);
            py = nearest(py, y, wrap.y, wrap.height);
        }
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

    /// Moves the centroid into the picture. A box may then reach beyond a side: the region continues at the other.
    void move_into(const Wrap& wrap)
    {
        const int right = wrap.x && x < -0.5 ? wrap.width : wrap.x && x >= wrap.width - 0.5 ? -wrap.width : 0;
        const int down = wrap.y && y < -0.5 ? wrap.height : wrap.y && y >= wrap.height - 0.5 ? -wrap.height : 0;
        x += right, xmin += right, xmax += right;
        y += down, ymin += down, ymax += down;
    }
};

std::vector<Region> measure(const ProgressiveImage::Data& data, const Partition& regions)
{
    const std::size_t channels = std::size_t(data.source.nchannels());
    std::vector<Region> all(regions.count, Region(channels));
    const float* samples = static_cast<const float*>(data.source.localpixels());
    const int width = data.picture.width;
    for (std::size_t p = 0; p < regions.labels.size(); ++p) {
        const int x = int(p % std::size_t(width)), y = int(p / std::size_t(width));
        all[regions.labels[p]].add(x, y, samples + data.wrap.place(x, y) * channels, data.wrap);
    }
    for (Region& region : all)
        region.move_into(data.wrap);
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

bool write_region_report(const ProgressiveImage::Data& data, const Partition& regions, const std::string& filename,
                         std::string& error)
{
    const bool as_json = OIIO::Strutil::iends_with(filename, ".json");
    const std::vector<Region> all = measure(data, regions);
    std::string text = as_json ? "[\n" : "";
    for (Index r = 0; r < regions.count; ++r) {
        const Fields record = fields(data.picture, r, all[r]);
        if (as_json)
            text += json(record) + (r + 1 < regions.count ? ",\n" : "\n]\n");
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

}  // namespace PIMG_ABI
}  // namespace pimg
