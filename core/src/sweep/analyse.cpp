// SPDX-License-Identifier: BSD-3-Clause
// Analysis of further channels: replays the splits to the finest level, then undoes them one by one.
#include <pimg/bands.h>
#include <pimg/detail/analyse.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr Level kReplayedBetweenStops = 2048;  ///< splits; undone in the mesh at a microsecond or two each

/// The volume equation of one collapse, solved for the intensity of s: a weighted mean of t, u and their ring,
///     z_s = z_t + sum of weight (z - z_t).
/// The weights are areas, so they hold for every channel.
struct VolumeStencil {
    int size = 0;
    Index vertex[2 * kMaxDegree];
    float weight[2 * kMaxDegree];
};

double area(Point a, Point b, Point c)
{
    return double(doubled_area(a, b, c));
}

/// For the edge from t (number s in `fine`) to u, its last vertex; `coarse` is where s will be.
VolumeStencil volume_stencil(const Mesh& fine, Index s, Index u, Point coarse)
{
    // The star of s: ring of t from vr to vl, then that of u back to vr.
    const RingView of_t = fine.ring(s), of_u = fine.ring(u);
    VolumeStencil stencil;
    Point points[2 * kMaxDegree];
    int n = 0;
    const auto add = [&](Index q) {
        points[n] = q == kGhost ? Point {} : fine.point(q);
        stencil.vertex[n++] = q;
    };
    const int at = int(std::find(of_t.begin(), of_t.end(), u) - of_t.begin());
    for (int k = at + 1; k < at + of_t.degree; ++k)
        add(of_t[k < of_t.degree ? k : k - of_t.degree]);
    const int vl = n - 1;
    const int back = int(std::find(of_u.begin(), of_u.end(), s) - of_u.begin());
    for (int k = back + 2; k < back + of_u.degree - 1; ++k)
        add(of_u[k < of_u.degree ? k : k - of_u.degree]);

    // Twice the area each corner of the star loses, old triangles minus new, and twice the area around u.
    const Point t = fine.point(s), pu = fine.point(u);
    double lost[2 * kMaxDegree] = {}, around_u = 0.0, star = 0.0;
    for (int i = 0; i < n; ++i) {
        const int next = i + 1 < n ? i + 1 : 0;
        if (stencil.vertex[i] == kGhost || stencil.vertex[next] == kGhost)
            continue;
        const double before = area(i < vl ? t : pu, points[i], points[next]);
        const double after = area(coarse, points[i], points[next]);
        star += after;
        around_u += i < vl ? 0.0 : before;
        lost[i] += before - after;
        lost[next] += before - after;
    }
    const auto share = [&](int corner, double shared) {
        if (stencil.vertex[corner] == kGhost)
            return;
        lost[corner] += shared;
        around_u += shared;
    };
    share(0, area(t, pu, points[0]));
    share(vl, area(t, points[vl], pu));
    for (int i = 0; i < n; ++i)
        if (stencil.vertex[i] != kGhost) {
            stencil.vertex[stencil.size] = stencil.vertex[i];
            stencil.weight[stencil.size++] = float(lost[i] / star);
        }
    stencil.vertex[stencil.size] = u;
    stencil.weight[stencil.size++] = float(around_u / star);
    return stencil;
}

}  // namespace

void subtract_predictions(const Hierarchy& h, const float* samples, Bands& bands)
{
    std::vector<float> values(h.vertices());
    std::vector<Detail>& details = bands.details;
    std::copy(bands.base.begin(), bands.base.end(), values.begin());
    in_stages(h.levels(), kBetweenStops, [&](Level first, Level last) {
        sweep_splits(h, first, last, values.data(), [&](Level i) {
            const SplitPair predicted = predict(h.stencils[i], values.data());
            details[i] = { details[i].t - predicted.t, details[i].u - predicted.u };
            return details[i];
        });
    });
    bands.residual.clear();
    if (h.between.empty())
        return;
    bands.residual.resize(h.mesh_pixels());
    scatter(h, values.data(), bands.residual.data());
    for (std::size_t p = 0; p < bands.residual.size(); ++p)
        bands.residual[p] = samples[p] - bands.residual[p];
}

Status analyse(const Hierarchy& h, const std::vector<const float*>& channels, std::vector<Bands>& bands,
               const ParallelFor& parallel)
{
    Mesh mesh;
    std::vector<Point> coarse(h.levels());
    if (const Status status = refine(h, h.levels(), mesh, &coarse); !status)
        return status;
    const Index base = h.base_vertices();
    std::vector<std::vector<float>> values(channels.size(), std::vector<float>(h.vertices()));
    bands.assign(channels.size(), {});
    run(parallel, channels.size(), [&](std::size_t c) {
        bands[c].details.resize(h.levels());
        for (Index v = 0; v < h.vertices(); ++v)
            values[c][v] = channels[c][h.pixels[v]];
    });
    constexpr Level kAhead = 16;  // splits are in no order in memory
    const auto fetch_values = [&](Index of) {
        for (const Index q : mesh.ring(of))
            for (const std::vector<float>& z : values)
                __builtin_prefetch(z.data() + (q == kGhost ? 0 : q));
    };
    for (Level i = h.levels(); i-- > 0;) {
        if (i % kReplayedBetweenStops == 0)
            stop_point();
        const Index s = h.splits[i].s, u = base + i;
        if (i >= kAhead) {
            mesh.prefetch(h.splits[i - kAhead].s);
            for (const Index later : { h.splits[i - kAhead / 2].s, u - kAhead / 2 }) {
                mesh.prefetch_around(later);
                fetch_values(later);
            }
        }
        const VolumeStencil stencil = volume_stencil(mesh, s, u, coarse[i]);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            float* z = values[c].data();
            float change = 0.0f;
            for (int k = 0; k < stencil.size; ++k)
                change += stencil.weight[k] * (z[stencil.vertex[k]] - z[s]);
            bands[c].details[i] = { z[s], z[u] };
            z[s] += change;
        }
        if (!mesh.collapse(s, coarse[i]))
            return Status::failure("hierarchy: split " + std::to_string(i) + " cannot be undone");
    }
    run(parallel, channels.size(), [&](std::size_t c) {
        bands[c].base.assign(values[c].begin(), values[c].begin() + base);
        subtract_predictions(h, channels[c], bands[c]);
    });
    return {};
}

}  // namespace PIMG_ABI
}  // namespace pimg
