// SPDX-License-Identifier: BSD-3-Clause
// Plans a painting in layers, from the widest brush to the narrowest. Each layer has its places on a grid. A place gets a
// stroke if pieces of that size are there and if the stroke brings the canvas closer to the picture, as the layers before
// have left it. So the places of a layer do not depend on each other: they are judged side by side, and noise that
// changes one stroke does not change the others.
#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>
#include <pimg/strokes.h>

#include <algorithm>
#include <cmath>

#include "planner.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// The paper gives the idea of section 5.2 but no numbers. Where nothing else is said, a number is chosen by eye.

/// How wrong bare canvas counts as, in tolerances. A stroke with a third of its cells on it is worth painting; with less, what is
/// bare is left to narrower strokes, or to be filled from below, and the wide strokes around it stay to be seen.
constexpr float kBare = 3.0f;

/// Widths of neighbouring layers are about this factor apart. Less gives more layers, which differ less.
constexpr float kOctave = 1.6f;

/// Distance of places, in widths. Less gives more paint on paint, and takes longer.
constexpr float kPitch = 1.1f;

/// The share of this distance at which dots lie, which have no length, and that of the widest strokes, which must cover all.
constexpr float kDotPitch = 0.65f, kGroundPitch = 0.85f;

/// Largest random shift of a place, as a share of the distance of places. With more there is less of a grid, but more
/// gaps.
constexpr float kScatter = 0.4f;

/// Length of a stroke in widths, ends included, and the largest random change of it, as a share.
constexpr float kLength = 4.0f, kLengthChance = 0.3f;

/// Pieces that are measured, for each square of the narrowest brush that fits into the picture. The hierarchy has the
/// important features in its first splits; what comes after so many pieces is not worth a brush of that size.
constexpr double kPiecesPerSquare = 2.0;

/// Cell of the sketch in least widths: 2 pixels for a least width of 3, which halved the time of planning.
constexpr float kCell = 0.67f;

/// Length, in widths, of a stroke that fills a gap.
constexpr float kGapLength = 3.0f;

/// The widths of the layers: those of a geometric series. Layer 0 has the narrowest brush of a place where the detail map changes
/// nothing; where it does, the range begins at another layer, above or below 0.
class Ladder {
public:
    explicit Ladder(const StrokeOptions& options) : m_options(options)
    {
        const double range = elementary::log2(double(options.max / options.min));
        m_layers = 1 + std::max(0, int(std::lround(range / elementary::log2(double(kOctave)))));
        m_step = m_layers > 1 ? range / (m_layers - 1) : elementary::log2(double(kOctave));
    }

    int layers() const { return m_layers; }
    int lowest() const { return m_options.detail ? shift(0.25f) : 0; }
    int highest() const { return (m_options.detail ? shift(4.0f) : 0) + m_layers - 1; }
    float width(int layer) const { return m_options.min * float(elementary::exp2(m_step * layer)); }
    /// The layer where the range of a place begins whose widths are scaled.
    int shift(float scale) const { return int(std::lround(elementary::log2(double(scale)) / m_step)); }
    /// The layer of a width.
    int layer(float width) const { return shift(width / m_options.min); }

private:
    const StrokeOptions& m_options;
    int m_layers;
    double m_step;  ///< octaves from one layer to the next
};

/// The places of a layer, on a grid that begins outside of the picture's upper left corner.
struct Places {
    int layer, columns, rows;
    float width, pitch;
    std::vector<Index> dab;  ///< of each cell: 1 + the last dab there of that size; 0 if there is none

    Places(const Ladder& ladder, int which, float distance, int picture_width, int picture_height)
        : layer(which),
          width(ladder.width(which)),
          pitch(distance * width)
    {
        columns = int(float(picture_width) / pitch) + 2;
        rows = int(float(picture_height) / pitch) + 2;
        dab.resize(std::size_t(columns) * std::size_t(rows), 0);
    }

    std::size_t cell(int x, int y) const { return std::size_t(y) * std::size_t(columns) + std::size_t(x); }
    void mark(Vec2 p, Index which)
    {
        const int x = int(p.x / pitch + 0.5f), y = int(p.y / pitch + 0.5f);
        dab[cell(std::clamp(x, 0, columns - 1), std::clamp(y, 0, rows - 1))] = which + 1;
    }
    /// The dab of a cell or of one next to it.
    Index dab_near(int x, int y) const
    {
        if (const Index own = dab[cell(x, y)])
            return own;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                if (x + dx >= 0 && y + dy >= 0 && x + dx < columns && y + dy < rows)
                    if (const Index next = dab[cell(x + dx, y + dy)])
                        return next;
        return 0;
    }
};

/// A stroke that is to be painted.
struct Chosen {
    Draft draft;
    Index vertex;
    Level level;
};

class LayerPlanner {
public:
    LayerPlanner(const ShadePyramid& pictures, const DirectionField& field, const StrokeOptions& options)
        : m_options(options),
          m_width(field.width()),
          m_height(field.height()),
          m_ladder(options),
          m_planner(pictures, field, options)
    {
    }

    /// Sorts the dabs into the places of all layers.
    void mark(const std::vector<Dab>& dabs);
    /// The strokes of a layer on a canvas, in the order of painting.
    std::vector<Chosen> choose(const Places& places, const Sketch& sketch) const;
    /// Strokes for what is bare.
    std::vector<Chosen> fill(Sketch& sketch) const;

    std::vector<Places> layers;  ///< the widest brush first

private:
    void choose_row(const Places& places, int y, const Sketch& sketch, std::vector<Chosen>& chosen) const;
    Site site(const Places& places, int x, int y) const;

    const StrokeOptions& m_options;
    int m_width, m_height;
    Ladder m_ladder;
    Planner m_planner;
    std::vector<Dab> m_dabs;
};

void LayerPlanner::mark(const std::vector<Dab>& dabs)
{
    m_dabs = dabs;
    const int lowest = m_ladder.lowest(), highest = m_ladder.highest();
    const float distance = kPitch * (kDotPitch + (1.0f - kDotPitch) * std::min(1.0f, m_options.length));
    for (int layer = highest; layer >= lowest; --layer)
        layers.emplace_back(m_ladder, layer, layer == highest ? kGroundPitch * distance : distance, m_width, m_height);
    for (Index i = 0; i < Index(dabs.size()); ++i) {
        const int layer = std::clamp(m_ladder.layer(dabs[i].width), lowest, highest);
        layers[std::size_t(highest - layer)].mark(dabs[i].centre, i);
    }
}

Site LayerPlanner::site(const Places& places, int x, int y) const
{
    const std::uint32_t chance =
        scramble(std::uint32_t(x)
                 + scramble(std::uint32_t(y) + scramble(std::uint32_t(places.layer) + scramble(m_options.seed))));
    const Vec2 place { places.pitch * (float(x) + kScatter * signed_unit(scramble(chance + 4))),
                       places.pitch * (float(y) + kScatter * signed_unit(scramble(chance + 5))) };
    const float scale = m_options.scale(place, m_width, m_height);
    return { place, places.width, m_options.min * scale, m_options.max * scale, chance };
}

void LayerPlanner::choose_row(const Places& places, int y, const Sketch& sketch, std::vector<Chosen>& chosen) const
{
    for (int x = 0; x < places.columns; ++x) {
        const Site site = this->site(places, x, y);
        const int above = places.layer - m_ladder.shift(site.narrowest / m_options.min);
        if (site.place.x < 0.0f || site.place.y < 0.0f || site.place.x > float(m_width - 1)
            || site.place.y > float(m_height - 1) || above < 0 || above >= m_ladder.layers())
            continue;
        const bool is_underpainting = above == m_ladder.layers() - 1;
        const Index dab = places.dab_near(x, y);
        if ((dab == 0 && !is_underpainting)
            || 0.5f + 0.5f * signed_unit(scramble(site.variation + 6)) > m_options.cover)
            continue;
        const float chance = 1.0f + kLengthChance * signed_unit(scramble(site.variation + 7));
        Draft draft = m_planner.draft(site, m_options.length * kLength * chance * places.width);
        if (!is_underpainting && m_options.tolerance > 0.0f) {
            const float gain =
                sketch.gain(draft.begin(), draft.size(), draft.width, draft.shade, kBare * m_options.tolerance);
            draft.opacity = std::clamp(gain / m_options.tolerance - 1.0f, 0.0f, 1.0f);
            if (draft.opacity <= 0.0f)
                continue;
        }
        chosen.push_back({ draft, dab ? m_dabs[dab - 1].vertex : kGhost, dab ? m_dabs[dab - 1].level : 0 });
    }
}

std::vector<Chosen> LayerPlanner::choose(const Places& places, const Sketch& sketch) const
{
    std::vector<std::vector<Chosen>> of_row(std::size_t(places.rows));
    run(m_options.parallel, of_row.size(), [&](std::size_t y) {
        stop_point();
        choose_row(places, int(y), sketch, of_row[y]);
    });
    std::vector<Chosen> all;
    for (const std::vector<Chosen>& row : of_row)
        all.insert(all.end(), row.begin(), row.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const Chosen& a, const Chosen& b) { return a.draft.variation < b.draft.variation; });
    return all;
}

std::vector<Chosen> LayerPlanner::fill(Sketch& sketch) const
{
    std::vector<Chosen> all;
    const float width = std::min(m_options.max, 2.0f * m_options.min);
    for (Vec2 place : sketch.bare_cells()) {
        stop_point();
        if (sketch.is_covered(place))
            continue;
        const Site site { place, width, m_options.min, m_options.max, scramble(Index(all.size())) };
        const Draft draft = m_planner.draft(site, kGapLength * width);
        sketch.put_below(draft.begin(), draft.size(), draft.width, draft.shade);
        all.push_back({ draft, kGhost, 0 });
    }
    return all;
}

void append(const std::vector<Chosen>& chosen, Strokes& strokes)
{
    for (const auto& [draft, vertex, level] : chosen) {
        strokes.strokes.push_back({ Index(strokes.points.size()), Index(draft.size()), draft.width, vertex, level,
                                    draft.variation, draft.opacity });
        strokes.points.insert(strokes.points.end(), draft.begin(), draft.begin() + draft.size());
    }
}

/// The dabs of the levels that can have features worth a brush.
Status dabs_of_features(const Hierarchy& hierarchy, const DirectionField& field, const StrokeOptions& options,
                        std::vector<Dab>& dabs)
{
    const double side = double(options.min) * (options.detail ? 0.25 : 1.0);
    DabOptions measured = options;
    measured.last = hierarchy.level_of_vertices(kPiecesPerSquare * double(hierarchy.mesh_pixels()) / (side * side));
    return collect_dabs(hierarchy, field, measured, dabs);
}

}  // namespace

Status plan_strokes(const Hierarchy& hierarchy, const ChannelsView& guides, const DirectionField& field,
                    const StrokeOptions& options, Strokes& strokes)
{
    std::vector<Dab> dabs;
    const Status status = dabs_of_features(hierarchy, field, options, dabs);
    if (!status)
        return status;
    const ShadePyramid pictures(guides, options.parallel);
    Sketch sketch(pictures.finest(), std::max(1, int(kCell * options.min + 0.5f)));
    LayerPlanner planner(pictures, field, options);
    planner.mark(dabs);

    std::vector<std::vector<Chosen>> laid;
    for (const Places& places : planner.layers) {
        laid.push_back(planner.choose(places, sketch));
        for (const Chosen& chosen : laid.back())
            sketch.put(chosen.draft.begin(), chosen.draft.size(), chosen.draft.width, chosen.draft.shade,
                       chosen.draft.opacity);
    }
    strokes = {};
    strokes.width = guides.width;
    strokes.height = guides.height;
    // Canvas that is still bare is covered by strokes below all others, which show in the gaps only.
    if (options.cover >= 1.0f)
        append(planner.fill(sketch), strokes);
    for (const std::vector<Chosen>& layer : laid)
        append(layer, strokes);
    return {};
}

std::vector<std::vector<float>> stroke_colours(const Strokes& strokes, const ChannelsView& picture,
                                               const ChannelsView& guides, const ParallelFor& parallel)
{
    constexpr std::size_t kBlock = 1024;
    // In steps of an 8-bit picture: colours that differ less count as the same paint. By eye; more makes colours
    // duller.
    constexpr float kAlike = 16.0f;
    const std::size_t n = strokes.strokes.size();
    std::vector<std::vector<float>> colours(picture.channels.size(), std::vector<float>(n));
    const auto pixel = [&](Vec2 p) {
        const int x = std::clamp(int(p.x + 0.5f), 0, picture.width - 1);
        const int y = std::clamp(int(p.y + 0.5f), 0, picture.height - 1);
        return std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
    };
    run(parallel, (n + kBlock - 1) / kBlock, [&](std::size_t block) {
        std::vector<double> sums(picture.channels.size());
        for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
            const Stroke& stroke = strokes.strokes[i];
            const Vec2* points = strokes.begin(stroke);
            const std::size_t centre = pixel(points[stroke.count / 2]);
            std::fill(sums.begin(), sums.end(), 0.0);
            double total = 0.0;
            for (Index k = 0; k < stroke.count; ++k) {
                const Vec2 p = points[k], next = points[k + 1 < stroke.count ? k + 1 : k - 1];
                const float dx = next.x - p.x, dy = next.y - p.y;
                const float side = 0.25f * stroke.width / std::max(std::sqrt(dx * dx + dy * dy), 1e-6f);
                for (int j = -1; j <= 1; ++j) {
                    const std::size_t at = pixel({ p.x - float(j) * side * dy, p.y + float(j) * side * dx });
                    float off = 0.0f;
                    for (const float* guide : guides.channels)
                        off += (guide[at] - guide[centre]) * (guide[at] - guide[centre]);
                    const double weight = 1.0 / (1.0 + double(off / (kAlike * kAlike)));
                    total += weight;
                    for (std::size_t c = 0; c < sums.size(); ++c)
                        sums[c] += weight * double(picture.channels[c][at]);
                }
            }
            for (std::size_t c = 0; c < sums.size(); ++c)
                colours[c][i] = float(sums[c] / total);
        }
    });
    return colours;
}

}  // namespace PIMG_ABI
}  // namespace pimg
