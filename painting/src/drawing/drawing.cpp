// SPDX-License-Identifier: BSD-3-Clause
// Lines to pixels: the canvas is cut into tiles, and every tile takes the lines that touch it in order.
#include <pimg/detail/parallel.h>
#include <pimg/drawing.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kTile = 64;  ///< pixels

/// Draws the lines of one tile.
class TilePen {
public:
    TilePen(int x0, int y0, const std::vector<std::vector<float>>& values, Canvas& canvas)
        : m_x0(x0),
          m_y0(y0),
          m_x1(std::min(x0 + kTile, canvas.width)),
          m_y1(std::min(y0 + kTile, canvas.height)),
          m_values(values),
          m_canvas(canvas)
    {
    }

    void draw(const InkPoint* points, Index count, Index ink)
    {
        m_left = m_top = kTile;
        m_right = m_bottom = 0;
        if (count == 1)
            cover(points[0], points[0]);
        for (Index k = 0; k + 1 < count; ++k)
            cover(points[k], points[k + 1]);
        blend(ink);
    }

private:
    void cover(const InkPoint& a, const InkPoint& b);
    void blend(Index ink);

    int m_x0, m_y0, m_x1, m_y1;
    const std::vector<std::vector<float>>& m_values;
    Canvas& m_canvas;
    int m_left = 0, m_top = 0, m_right = 0, m_bottom = 0;  ///< of the tile's pixels that the line has touched
    float m_cover[kTile * kTile] = {};                     ///< share of each pixel that the line covers
};

/// Each pixel counts as a square turned in the direction of the line, so that the share the line covers is the overlap
/// of two intervals. Lines narrower than a pixel thus become as dark as they should be.
void TilePen::cover(const InkPoint& a, const InkPoint& b)
{
    const float reach = 0.5f * std::max(a.width, b.width) + 1.0f;
    const int x0 = std::max(m_x0, int(std::floor(std::min(a.x, b.x) - reach)));
    const int y0 = std::max(m_y0, int(std::floor(std::min(a.y, b.y) - reach)));
    const int x1 = std::min(m_x1, int(std::ceil(std::max(a.x, b.x) + reach)) + 1);
    const int y1 = std::min(m_y1, int(std::ceil(std::max(a.y, b.y) + reach)) + 1);
    if (x0 >= x1 || y0 >= y1)
        return;
    const float dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const float inverse = square > 0.0f ? 1.0f / square : 0.0f;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float px = float(x) - a.x, py = float(y) - a.y;
            const float t = std::clamp((px * dx + py * dy) * inverse, 0.0f, 1.0f);
            const float ox = px - t * dx, oy = py - t * dy, off = std::sqrt(ox * ox + oy * oy);
            const float half = 0.5f * (a.width + t * (b.width - a.width));
            const float share = std::min(half, off + 0.5f) - std::max(-half, off - 0.5f);
            float& most = m_cover[(y - m_y0) * kTile + x - m_x0];
            most = std::max(most, share);
        }
    m_left = std::min(m_left, x0 - m_x0);
    m_top = std::min(m_top, y0 - m_y0);
    m_right = std::max(m_right, x1 - m_x0);
    m_bottom = std::max(m_bottom, y1 - m_y0);
}

void TilePen::blend(Index ink)
{
    for (int y = m_top; y < m_bottom; ++y) {
        float* cover = m_cover + y * kTile;
        const std::size_t row = std::size_t(m_y0 + y) * std::size_t(m_canvas.width) + std::size_t(m_x0);
        for (std::size_t c = 0; c < m_canvas.channels.size(); ++c) {
            const float value = m_values[c][ink];
            float* out = m_canvas.channels[c] + row;
            for (int x = m_left; x < m_right; ++x)
                out[x] += cover[x] * (value - out[x]);
        }
        if (m_left < m_right)
            std::fill(cover + m_left, cover + m_right, 0.0f);
    }
}

/// The larger of two numbers: the distance of p from the segment a - b, and how far its width is from that of the
/// segment at the nearest place.
float distance(const InkPoint& p, const InkPoint& a, const InkPoint& b)
{
    const float dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const float t = square > 0.0f ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0f, 1.0f) : 0.0f;
    const float ox = p.x - a.x - t * dx, oy = p.y - a.y - t * dy;
    return std::max(std::sqrt(ox * ox + oy * oy), 0.5f * std::fabs(p.width - a.width - t * (b.width - a.width)));
}

/// Marks the points to keep between two that are kept (Douglas and Peucker 1973).
void mark_kept(const InkPoint* p, Index count, float tolerance, std::vector<char>& kept)
{
    kept.assign(count, 0);
    kept[0] = kept[count - 1] = 1;
    std::vector<std::pair<Index, Index>> parts { { 0, count - 1 } };
    while (!parts.empty()) {
        const auto [first, last] = parts.back();
        parts.pop_back();
        Index farthest = first;
        float most = tolerance;
        for (Index k = first + 1; k < last; ++k) {
            const float off = distance(p[k], p[first], p[last]);
            if (off > most) {
                most = off;
                farthest = k;
            }
        }
        if (farthest == first)
            continue;
        kept[farthest] = 1;
        parts.emplace_back(first, farthest);
        parts.emplace_back(farthest, last);
    }
}

float square_of(float x)
{
    return x * x;
}

/// The ends of lines in square cells, to find the nearest of those that are left.
class LineEnds {
public:
    LineEnds(const Drawing& drawing, const std::vector<Index>& lines) : m_drawing(drawing), m_left(lines.size())
    {
        const float area = float(std::max(1, drawing.width)) * float(std::max(1, drawing.height));
        m_cell = std::max(1.0f, std::sqrt(area / float(std::max<std::size_t>(1, lines.size()))));
        m_columns = int(float(drawing.width) / m_cell) + 1;
        m_rows = int(float(drawing.height) / m_cell) + 1;
        m_cells.resize(std::size_t(m_columns) * std::size_t(m_rows));
        for (const Index line : lines)
            for (const bool at_end : { false, true })
                m_cells[cell_of(end(line, at_end))].push_back({ line, at_end });
    }

    struct End {
        Index line;
        bool at_end;  ///< the last point, else the first
    };

    /// Removes the line that has the end nearest to p, and returns that end. There must be a line left.
    End take_nearest(const InkPoint& p);
    bool empty() const { return m_left == 0; }

private:
    const InkPoint& end(Index line, bool at_end) const
    {
        const InkLine& l = m_drawing.lines[line];
        return m_drawing.begin(l)[at_end ? l.count - 1 : 0];
    }
    int column(float x) const { return std::clamp(int(x / m_cell), 0, m_columns - 1); }
    int row(float y) const { return std::clamp(int(y / m_cell), 0, m_rows - 1); }
    std::size_t cell_of(const InkPoint& p) const
    {
        return std::size_t(row(p.y)) * std::size_t(m_columns) + std::size_t(column(p.x));
    }
    void look(int x, int y, const InkPoint& p, End& nearest, float& least) const;
    void remove(Index line, bool at_end);

    const Drawing& m_drawing;
    std::size_t m_left;
    float m_cell = 1.0f;
    int m_columns = 1, m_rows = 1;
    std::vector<std::vector<End>> m_cells;
};

void LineEnds::look(int x, int y, const InkPoint& p, End& nearest, float& least) const
{
    if (x < 0 || y < 0 || x >= m_columns || y >= m_rows)
        return;
    for (const End& e : m_cells[std::size_t(y) * std::size_t(m_columns) + std::size_t(x)]) {
        const InkPoint& q = end(e.line, e.at_end);
        const float d = square_of(q.x - p.x) + square_of(q.y - p.y);
        if (d < least) {
            least = d;
            nearest = e;
        }
    }
}

void LineEnds::remove(Index line, bool at_end)
{
    std::vector<End>& cell = m_cells[cell_of(end(line, at_end))];
    cell.erase(
        std::find_if(cell.begin(), cell.end(), [&](const End& e) { return e.line == line && e.at_end == at_end; }));
}

LineEnds::End LineEnds::take_nearest(const InkPoint& p)
{
    End nearest { 0, false };
    float least = 1e30f;
    const int cx = column(p.x), cy = row(p.y);
    // Rings of cells around p; those beyond the nearest end found so far cannot hold a nearer one.
    for (int r = 0; r <= std::max(m_columns, m_rows) && square_of(float(r - 1) * m_cell) <= least; ++r)
        for (int y = cy - r; y <= cy + r; ++y) {
            const int step = y == cy - r || y == cy + r ? 1 : std::max(1, 2 * r);
            for (int x = cx - r; x <= cx + r; x += step)
                look(x, y, p, nearest, least);
        }
    remove(nearest.line, false);
    remove(nearest.line, true);
    --m_left;
    return nearest;
}

}  // namespace

Drawing resized(const Drawing& drawing, int width, int height)
{
    Drawing result = drawing;
    result.width = width;
    result.height = height;
    const float sx = float(width) / float(drawing.width), sy = float(height) / float(drawing.height);
    for (InkPoint& p : result.points)
        p = { (p.x + 0.5f) * sx - 0.5f, (p.y + 0.5f) * sy - 0.5f, p.width * std::sqrt(sx * sy) };
    return result;
}

void simplify_lines(Drawing& drawing, float tolerance)
{
    std::vector<InkPoint> points;
    std::vector<char> kept;
    for (InkLine& line : drawing.lines) {
        const InkPoint* p = drawing.begin(line);
        mark_kept(p, line.count, tolerance, kept);
        const Index first = Index(points.size());
        for (Index k = 0; k < line.count; ++k)
            if (kept[k])
                points.push_back(p[k]);
        line.first = first;
        line.count = Index(points.size()) - first;
    }
    drawing.points = std::move(points);
}

void sort_lines(Drawing& drawing)
{
    std::vector<InkLine> sorted;
    InkPoint pen { 0.0f, 0.0f, 0.0f };
    for (Index ink = 0; ink < Index(drawing.inks.size()); ++ink) {
        std::vector<Index> lines;
        for (Index i = 0; i < Index(drawing.lines.size()); ++i)
            if (drawing.lines[i].ink == ink)
                lines.push_back(i);
        for (LineEnds ends(drawing, lines); !ends.empty();) {
            const auto [line, at_end] = ends.take_nearest(pen);
            const InkLine& next = drawing.lines[line];
            if (at_end)
                std::reverse(drawing.begin(next), drawing.begin(next) + next.count);
            pen = drawing.begin(next)[next.count - 1];
            sorted.push_back(next);
        }
    }
    drawing.lines = std::move(sorted);
}

double pen_travel(const Drawing& drawing)
{
    double travel = 0.0;
    for (std::size_t i = 1; i < drawing.lines.size(); ++i) {
        const InkLine& before = drawing.lines[i - 1];
        const InkPoint &a = drawing.begin(before)[before.count - 1], &b = *drawing.begin(drawing.lines[i]);
        travel += std::sqrt(double(square_of(b.x - a.x) + square_of(b.y - a.y)));
    }
    return travel;
}

void render_drawing(const Drawing& drawing, const std::vector<std::vector<float>>& values, Canvas& canvas,
                    const ParallelFor& parallel)
{
    const int columns = (canvas.width + kTile - 1) / kTile, rows = (canvas.height + kTile - 1) / kTile;
    std::vector<std::vector<Index>> of_tile(std::size_t(columns) * std::size_t(rows));
    for (Index i = 0; i < Index(drawing.lines.size()); ++i) {
        const InkLine& line = drawing.lines[i];
        float low_x = 1e30f, low_y = 1e30f, high_x = -1e30f, high_y = -1e30f;
        for (const InkPoint* p = drawing.begin(line); p != drawing.begin(line) + line.count; ++p) {
            const float reach = 0.5f * p->width + 1.0f;
            low_x = std::min(low_x, p->x - reach);
            low_y = std::min(low_y, p->y - reach);
            high_x = std::max(high_x, p->x + reach);
            high_y = std::max(high_y, p->y + reach);
        }
        const int x1 = std::min(columns - 1, int(std::max(0.0f, high_x)) / kTile);
        const int y1 = std::min(rows - 1, int(std::max(0.0f, high_y)) / kTile);
        for (int y = int(std::max(0.0f, low_y)) / kTile; y <= y1; ++y)
            for (int x = int(std::max(0.0f, low_x)) / kTile; x <= x1; ++x)
                of_tile[std::size_t(y) * std::size_t(columns) + std::size_t(x)].push_back(i);
    }
    run(parallel, of_tile.size(), [&](std::size_t t) {
        TilePen pen(int(t % std::size_t(columns)) * kTile, int(t / std::size_t(columns)) * kTile, values, canvas);
        for (const Index i : of_tile[t])
            pen.draw(drawing.begin(drawing.lines[i]), drawing.lines[i].count, drawing.lines[i].ink);
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
