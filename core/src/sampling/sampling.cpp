// SPDX-License-Identifier: BSD-3-Clause
// Control maps, densities and error diffusion.
#include <pimg/detail/parallel.h>
#include <pimg/sampling.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <pimg/detail/delaunay.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kStrip = 64;  ///< rows worked on at a time

/// Share of the samples spread evenly. Without it a flat place next to an edge is spanned by fans of slivers; more
/// costs accuracy (docs/adaptive.md).
constexpr double kEvenShare = 0.1;

template<class Work>
void for_strips(int height, const ParallelFor& parallel, Work&& work)
{
    const std::size_t strips = std::size_t((height + kStrip - 1) / kStrip);
    run(parallel, strips, [&](std::size_t s) { work(s, int(s) * kStrip, std::min(height, int(s + 1) * kStrip)); });
}

float square(float v)
{
    return v * v;
}

/// Pixel (x, y) and those around it: rows and columns beyond the picture repeat its sides.
struct Neighbourhood {
    const float *above, *here, *below;
    int left, x, right;
};

float squared_gradient(const Neighbourhood& n)
{
    const float z = n.here[n.x];
    return square(n.here[n.right] - z) + square(n.here[n.left] - z) + square(n.below[n.x] - z)
        + square(n.above[n.x] - z);
}

float squared_curvature(const Neighbourhood& n)
{
    const float z = n.here[n.x];
    const float xx = n.here[n.left] + n.here[n.right] - 2.0f * z, yy = n.above[n.x] + n.below[n.x] - 2.0f * z;
    const float xy = 0.25f * (n.below[n.right] + n.above[n.left] - n.below[n.left] - n.above[n.right]);
    return square(xx) + square(yy) + 2.0f * square(xy);
}

template<class Measure>
void add_row(const GuideChannel& channel, int width, int height, int y, Measure&& measure, float* map)
{
    const auto row = [&](int r) {
        return channel.samples + std::size_t(std::clamp(r, 0, height - 1)) * std::size_t(width);
    };
    const float *above = row(y - 1), *here = row(y), *below = row(y + 1);
    const auto add = [&](int left, int x, int right) {
        map[x] += channel.weight * measure(Neighbourhood { above, here, below, left, x, right });
    };
    add(0, 0, 1);
    for (int x = 1; x + 1 < width; ++x)
        add(x - 1, x, x + 1);
    add(width - 2, width - 1, width - 1);
}

/// How much of the map there is at each magnitude: 64 classes an octave, from the bits of its floats.
class Histogram {
public:
    void add(const float* values, std::size_t n)
    {
        for (std::size_t i = 0; i < n; ++i) {
            Class& c = m_classes[class_of(values[i])];
            ++c.count;
            c.sum += double(values[i]);
        }
    }
    void add(const Histogram& other)
    {
        for (std::size_t k = 0; k < m_classes.size(); ++k) {
            m_classes[k].count += other.m_classes[k].count;
            m_classes[k].sum += other.m_classes[k].sum;
        }
    }

    /// The scale that gives min(1, even + scale * value) the wanted sum; 0 if there is nothing to scale.
    double scale_for(double wanted, double even) const;

private:
    struct Class {
        std::size_t count = 0;
        double sum = 0.0;
    };
    static std::size_t class_of(float value)
    {
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        return bits >> 17;
    }
    std::vector<Class> m_classes = std::vector<Class>(1 << 14);  // no sign: values are not negative
};

double Histogram::scale_for(double wanted, double even) const
{
    Class rest;
    for (const Class& c : m_classes) {
        rest.count += c.count;
        rest.sum += c.sum;
    }
    // Classes from the top are full (1 a pixel) until the others, scaled, stay below 1.
    double full = 0.0;
    for (std::size_t k = m_classes.size(); k-- > 0 && rest.sum > 0.0;) {
        const Class& c = m_classes[k];
        if (c.count == 0)
            continue;
        const double scale = (wanted - full - even * double(rest.count)) / rest.sum;
        if (scale * c.sum / double(c.count) + even <= 1.0)
            return std::max(0.0, scale);
        full += double(c.count);
        rest.count -= c.count;
        rest.sum -= c.sum;
    }
    return 1e30;  // everything that is not 0 is wanted
}

}  // namespace

std::vector<float> control_map(const Guide& guide, Control control, const ParallelFor& parallel)
{
    const int width = guide.width, height = guide.height;
    std::vector<float> map(std::size_t(width) * std::size_t(height), 0.0f);
    for_strips(height, parallel, [&](std::size_t, int y0, int y1) {
        for (int y = y0; y < y1; ++y) {
            float* row = map.data() + std::size_t(y) * std::size_t(width);
            for (const GuideChannel& c : guide.channels)
                if (control == Control::gradient)
                    add_row(c, width, height, y, squared_gradient, row);
                else
                    add_row(c, width, height, y, squared_curvature, row);
            for (int x = 0; x < width; ++x)
                row[x] = std::sqrt(row[x]);
        }
    });
    return map;
}

void to_density(std::vector<float>& map, double density, const ParallelFor& parallel)
{
    constexpr std::size_t kMapBatch = 1 << 20;
    const std::size_t batches = (map.size() + kMapBatch - 1) / kMapBatch;
    const auto for_batches = [&](const std::function<void(std::size_t, float*, std::size_t)>& work) {
        run(parallel, batches, [&](std::size_t b) {
            work(b, map.data() + b * kMapBatch, std::min(kMapBatch, map.size() - b * kMapBatch));
        });
    };
    std::vector<Histogram> histograms(batches);
    for_batches([&](std::size_t b, float* values, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i)
            values[i] = values[i] > 0.0f ? std::min(values[i], 1e30f) : 0.0f;
        histograms[b].add(values, n);
    });
    for (std::size_t b = 1; b < batches; ++b)
        histograms[0].add(histograms[b]);
    const double even = density < 1.0 ? kEvenShare * density : 1.0;
    const double scale = histograms[0].scale_for(density * double(map.size()), even);
    for_batches([&](std::size_t, float* values, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i)
            values[i] = float(std::min(1.0, even + scale * double(values[i])));
    });
}

std::vector<Index> halftone(const std::vector<float>& probability, int width, int height)
{
    std::vector<float> error[2];
    for (auto& e : error)
        e.assign(std::size_t(width) + 2, 0.0f);
    std::vector<char> chosen(static_cast<std::size_t>(width));
    std::vector<Index> pixels;
    for (int y = 0; y < height; ++y) {
        float *here = error[y & 1].data() + 1, *below = error[~y & 1].data() + 1;
        std::fill(below - 1, below + width + 1, 0.0f);
        const float* row = probability.data() + std::size_t(y) * std::size_t(width);
        const bool side_y = y == 0 || y == height - 1;
        const int step = y & 1 ? -1 : 1;
        for (int i = 0, x = y & 1 ? width - 1 : 0; i < width; ++i, x += step) {
            const bool side_x = x == 0 || x == width - 1;
            const float wanted = (side_x || side_y ? std::sqrt(row[x]) : row[x]) + here[x];
            const bool keep = wanted >= 0.5f || (side_x && side_y);
            chosen[std::size_t(x)] = keep;
            const float rest = (wanted - (keep ? 1.0f : 0.0f)) / 16.0f;
            here[x + step] += 7.0f * rest;
            below[x - step] += 3.0f * rest;
            below[x] += 5.0f * rest;
            below[x + step] += rest;
        }
        for (int x = 0; x < width; ++x)
            if (chosen[std::size_t(x)])
                pixels.push_back(Index(y) * Index(width) + Index(x));
    }
    return pixels;
}

namespace {

/// Adds the pixels halfway to the neighbours of some vertices, or, should all those be there, the pixels around them:
/// with these a vertex has eight neighbours, so that repeating this comes to an end.
void thicken(const std::vector<Index>& vertices, InitialMesh& mesh)
{
    std::vector<Index>& pixels = mesh.pixels;
    const std::size_t before = pixels.size();
    std::vector<Index> added;
    const auto add = [&](int x, int y) {
        added.push_back(Index(y) * Index(mesh.width) + Index(x));
    };
    std::vector<bool> crowded(pixels.size());
    for (Index v : vertices)
        crowded[v] = true;
    for (Index e = 0; e < Index(mesh.corners.size()); ++e)
        if (crowded[mesh.corners[e]]) {
            const Point p = mesh.pixel(mesh.corners[e]), q = mesh.pixel(mesh.corners[next_edge(e)]);
            add((p.x + q.x) / 2, (p.y + q.y) / 2);
        }
    const auto merge = [&] {
        pixels.insert(pixels.end(), added.begin(), added.end());
        std::sort(pixels.begin(), pixels.end());
        pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
    };
    std::vector<Point> around;
    around.reserve(vertices.size());
    for (Index v : vertices)
        around.push_back(mesh.pixel(v));
    merge();
    if (pixels.size() > before)
        return;
    for (Point p : around)
        for (int y = std::max(0, p.y - 1); y <= std::min(mesh.height - 1, p.y + 1); ++y)
            for (int x = std::max(0, p.x - 1); x <= std::min(mesh.width - 1, p.x + 1); ++x)
                add(x, y);
    merge();
}

}  // namespace

InitialMesh triangulate(std::vector<Index> pixels, const Guide& guide)
{
    InitialMesh mesh;
    mesh.width = guide.width;
    mesh.height = guide.height;
    mesh.pixels = std::move(pixels);
    for (;;) {
        triangulate_delaunay(mesh, guide);
        const std::vector<Index> crowded = limit_degrees(mesh);
        if (crowded.empty())
            return mesh;
        thicken(crowded, mesh);
    }
}

Status sample(const Guide& guide, const SamplingOptions& options, InitialMesh& mesh)
{
    if (guide.width < 2 || guide.height < 2 || guide.channels.empty())
        return Status::failure("guide: expected 2 x 2 pixels or more for an adaptive mesh");
    if (!(options.density > 0.0 && options.density <= 1.0))
        return Status::failure("density: expected a number above 0, at most 1");
    const auto go_on = [&](float done) {
        return !options.progress || options.progress(done);
    };
    const std::size_t n = std::size_t(guide.width) * std::size_t(guide.height);
    std::vector<float> map = options.map ? std::vector<float>(options.map, options.map + n)
                                         : control_map(guide, options.control, options.parallel);
    to_density(map, options.density, options.parallel);
    if (!go_on(0.2f))
        return Status::failure("building was stopped");
    std::vector<Index> pixels = halftone(map, guide.width, guide.height);
    std::vector<float>().swap(map);
    constexpr std::size_t kMost = 700'000'000;  // six half-edges each, numbered in 32 bits
    if (pixels.size() > kMost)
        return Status::failure("density: expected at most 7e8 vertices, choose a lower one");
    if (!go_on(0.4f))
        return Status::failure("building was stopped");
    mesh = triangulate(std::move(pixels), guide);
    return go_on(1.0f) ? Status() : Status::failure("building was stopped");
}

}  // namespace PIMG_ABI
}  // namespace pimg
