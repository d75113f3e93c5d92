// SPDX-License-Identifier: BSD-3-Clause
// The driver of simplification. Access to memory takes its time, not arithmetic, so there is no global queue. Tiles are
// visited in order, and each is collapsed up to a cost limit while it is in the cache. The limit rises from sweep to
// sweep; inside a tile it rises in finer steps. Keys are lazy: a vertex is evaluated again only when the limit reaches
// its old cost. docs/internals.md shows why this loses no quality.
#include <pimg/channels.h>
#include <pimg/detail/parallel.h>
#include <pimg/simplify.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simplify/collapse_record.h"
#include "simplify/metrics/collapse_metric.h"
#include "simplify/tile_worker.h"
#include "simplify/working_mesh.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr float kFirstLimit = 1e-3f;  ///< about the cost floor of a pixel-sized edge
constexpr float kSweepFactor = 4.0f;  ///< between the limits of successive sweeps
constexpr const char* kStopped = "building was stopped";
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Share of the vertices that bisection may remove.
constexpr double kMostBisected = 2.0 / 3.0;

/// Shape a triangle must keep: twice its area over its longest edge squared. The second
/// value only serves to finish down to the corners when the first leaves nothing to do.
constexpr float kGuards[2] = { 1e-3f, 1e-5f };

class Simplifier {
public:
    /// `done`: the collapses by which the mesh was made.
    Simplifier(WorkingMesh&& mesh, CollapseSequence&& done, const SimplifyOptions& options)
        : m_mesh(std::move(mesh)),
          m_options(options),
          m_sequence(std::move(done)),
          m_total(m_mesh.alive())
    {
        m_sequence.channels = m_mesh.more_channels + 1;
        m_stats.collapses = m_sequence.records.size();
        // Takes memory only as it fills; growing would need twice as much for a moment.
        m_sequence.records.reserve(m_sequence.records.size() + m_total);
        pimg::run(options.parallel, m_mesh.tiles.size(), [&](std::size_t i) { start_tile(m_mesh, m_mesh.tiles[i]); });
    }

    /// False when progress asked to stop.
    bool run();

    CollapseSequence take_sequence();
    const SimplifyStats& stats() const { return m_stats; }

private:
    bool sweep(float limit);
    void sweep_colour(int colour, float limit);
    void collect(std::size_t n);
    void measure();
    bool anything_left() const;
    bool report() const;

    WorkingMesh m_mesh;
    const SimplifyOptions& m_options;
    CollapseSequence m_sequence;
    Index m_total;  ///< vertices before the first collapse of its own
    float m_guard = kGuards[0];
    std::vector<Index> m_deferred;
    std::vector<TileOutput> m_outputs;
    SimplifyStats m_stats;
};

bool Simplifier::run()
{
    for (float guard : kGuards) {
        if (guard != m_guard)
            for (Index v = 0; v < Index(m_mesh.nodes.size()); ++v)
                m_mesh.keys[v] = m_mesh.nodes[v].degree > 0 ? 0.0f : kInfinity;
        m_guard = guard;
        for (float limit = kFirstLimit; anything_left(); limit *= kSweepFactor)
            if (!sweep(std::min(limit, std::numeric_limits<float>::max())))
                return false;
    }
    return true;
}

bool Simplifier::sweep(float limit)
{
    for (int colour = 0; colour < 4; ++colour) {
        sweep_colour(colour, limit);
        if (!report())
            return false;
    }
    // Collapses that reach beyond the zone of their tile: one after the other, by one thread.
    std::vector<Index> deferred;
    deferred.swap(m_deferred);
    collapse_listed(m_mesh, deferred, { kEverywhere, limit, m_guard }, m_outputs[0]);
    collect(1);
    m_mesh.compact_if_sparse(m_options.parallel);
    return true;
}

void Simplifier::sweep_colour(int colour, float limit)
{
    std::vector<const Tile*> tiles;
    for (const Tile& tile : m_mesh.tiles)
        if (int(tile.x & 1) + 2 * int(tile.y & 1) == colour)
            tiles.push_back(&tile);
    m_outputs.resize(std::max(m_outputs.size(), tiles.size()));
    pimg::run(m_options.parallel, tiles.size(), [&](std::size_t i) {
        collapse_tile(m_mesh, *tiles[i], { m_mesh.zone(*tiles[i]), limit, m_guard }, m_outputs[i]);
    });
    collect(tiles.size());
}

/// Appends what the first n tiles left, in their order.
void Simplifier::collect(std::size_t n)
{
    std::vector<std::size_t> first(n);
    for (std::size_t i = 0; i < n; ++i) {
        const TileOutput& output = m_outputs[i];
        first[i] = m_stats.collapses;
        m_deferred.insert(m_deferred.end(), output.deferred.begin(), output.deferred.end());
        m_stats.collapses += output.records.size();
        m_stats.evaluations += output.evaluations;
        m_stats.refused += output.refused;
    }
    const std::size_t added = m_stats.collapses - m_sequence.records.size();
    m_mesh.add_dead(Index(added));
    m_sequence.records.extend(added);
    m_sequence.more.extend(added * std::size_t(m_mesh.more_channels));
    measure();
    pimg::run(m_options.parallel, n, [&](std::size_t i) {
        TileOutput& output = m_outputs[i];
        for (std::size_t k = 0; k < output.records.size(); ++k)
            m_sequence.records.set(first[i] + k, output.records[k]);
        std::copy(output.more.begin(), output.more.end(),
                  m_sequence.more.begin() + first[i] * std::size_t(m_mesh.more_channels));
        output.clear();
    });
}

void Simplifier::measure()
{
    std::size_t bytes = m_mesh.bytes() + m_sequence.records.bytes() + m_sequence.more.size() * sizeof(SplitPair);
    for (const TileOutput& output : m_outputs)
        bytes += output.bytes();
    m_stats.peak_bytes = std::max(m_stats.peak_bytes, bytes);
}

bool Simplifier::anything_left() const
{
    return std::any_of(m_mesh.keys.begin(), m_mesh.keys.end(), [](float key) { return key < kInfinity; });
}

bool Simplifier::report() const
{
    return !m_options.progress || m_options.progress(1.0f - float(m_mesh.alive()) / float(m_total));
}

CollapseSequence Simplifier::take_sequence()
{
    std::vector<BaseVertex>& base = m_sequence.base;
    for (Index v = 0; v < Index(m_mesh.nodes.size()); ++v) {
        const Node& node = m_mesh.nodes[v];
        if (node.degree == 0)
            continue;
        BaseVertex b { node.name, node.p, { node.z }, m_mesh.rings[v], node.degree };
        for (int c = 0; c < m_mesh.more_channels; ++c)
            b.z.push_back(m_mesh.more_of(v)[c].value);
        for (int j = 0; j < b.degree; ++j) {
            Index& q = b.ring.v[std::size_t(j)];
            q = q == kGhost ? kGhost : m_mesh.nodes[q].name;
        }
        base.push_back(std::move(b));
    }
    std::sort(base.begin(), base.end(), [](const BaseVertex& a, const BaseVertex& b) { return a.name < b.name; });
    return std::move(m_sequence);
}

/// One line on what is wrong with a guide; nothing if it can be built from.
Status check(const Guide& guide)
{
    constexpr int kMaxSide = 1 << 20;  // lattice coordinates fit into 32 bits
    if (guide.width < 1 || guide.height < 1)
        return Status::failure("the picture is empty");
    if (guide.width > kMaxSide || guide.height > kMaxSide
        || std::uint64_t(guide.width) * std::uint64_t(guide.height) > (1ull << 31))
        return Status::failure("the picture is larger than 2^20 pixels a side or 2^31 in all");
    if (guide.channels.empty() || guide.channels.size() > std::size_t(kMaxGuideChannels))
        return Status::failure("guide: expected 1 to " + std::to_string(kMaxGuideChannels) + " channels");
    for (const GuideChannel& c : guide.channels)
        if (!c.samples || !(c.weight > 0.0f) || !std::isfinite(c.weight))
            return Status::failure("a guide channel has no samples or a weight that is not positive");
    return {};
}

/// One line on what is wrong with the options.
Status check(const SimplifyOptions& options, const Hierarchy& shape)
{
    const InitialMesh& start = options.start;
    if (!(options.bisection >= 0.0f) || !std::isfinite(options.bisection))
        return Status::failure("bisection: expected a cost from 0 up");
    if (start.vertices() == 0)
        return {};
    if (options.metric != Metric::volume)
        return Status::failure(
            "an initial mesh needs the metric volume: quadric and exact start from one vertex per pixel");
    if (start.twins.size() != start.corners.size())
        return Status::failure("the initial mesh has no twins");
    if (start.width != shape.mesh_width() || start.height != shape.mesh_height())
        return Status::failure("the initial mesh is for a picture of another size");
    return {};
}

/// The mesh to collapse, and in `bisected` what was collapsed on the way to it.
WorkingMesh initial_mesh(const Guide& on_mesh, const SimplifyOptions& options, CollapseSequence& bisected)
{
    if (options.start.vertices() > 0)
        return WorkingMesh(on_mesh, options.start);
    if (!(options.bisection > 0.0f))
        return WorkingMesh(on_mesh, options.parallel);
    const Bisection bisection(on_mesh, { options.bisection, kMostBisected }, options.parallel, bisected);
    return WorkingMesh(on_mesh, bisection, options.parallel);
}

/// Collapses all there is to collapse; the memory of the mesh's twins is given back on the way.
Status collapse(const Guide& on_mesh, SimplifyOptions& options, CollapseSequence& sequence, SimplifyStats& stats)
{
    if (options.metric != Metric::volume) {
        PlainMesh mesh(on_mesh);
        const auto metric = options.metric == Metric::quadric ? quadric_metric(mesh) : exact_metric(mesh);
        return collapse_all(mesh, *metric, options.progress, sequence, stats) ? Status() : Status::failure(kStopped);
    }
    CollapseSequence bisected;
    Simplifier simplifier(initial_mesh(on_mesh, options, bisected), std::move(bisected), options);
    std::vector<Index>().swap(options.start.twins);
    if (!simplifier.run())
        return Status::failure(kStopped);
    sequence = simplifier.take_sequence();
    stats = simplifier.stats();
    return {};
}

}  // namespace

Status simplify(const Guide& guide, SimplifyOptions options, Hierarchy& hierarchy, std::vector<Bands>& bands,
                SimplifyStats* stats)
{
    if (options.initial && options.start.vertices() == 0)
        options.start = *options.initial;
    Hierarchy shape;
    shape.width = guide.width;
    shape.height = guide.height;
    Status status = check(guide);
    if (status)
        status = check(options, shape);
    if (!status)
        return status;
    Guide on_mesh { shape.mesh_width(), shape.mesh_height(), guide.channels };
    Channels samples;
    if (guide.width < 2 || guide.height < 2)
        for (GuideChannel& c : on_mesh.channels) {
            samples.push_back(to_mesh_pixels(shape, c.samples));
            c.samples = samples.back().data();
        }
    CollapseSequence sequence;
    SimplifyStats counted;
    status = collapse(on_mesh, options, sequence, counted);
    if (!status)
        return status;
    if (stats)
        *stats = counted;
    const Finest finest { on_mesh, options.start.vertices() > 0 ? &options.start : nullptr, options.parallel };
    return assemble(guide.width, guide.height, finest, std::move(sequence), options.base_faces, hierarchy, bands);
}

}  // namespace PIMG_ABI
}  // namespace pimg
