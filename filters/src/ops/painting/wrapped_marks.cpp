// SPDX-License-Identifier: BSD-3-Clause
#include "ops/painting/wrapped_marks.h"

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Pixels by which a mark may miss the picture and still be drawn: the light on the relief of paint looks so far.
constexpr float kNear = 2.0f;

/// What a mark covers in the padded picture, and its middle.
struct Extent {
    float x0, y0, x1, y1, middle_x, middle_y;
};

template<class Point>
Extent extent_of(const Point* points, Index count, float reach)
{
    const Point middle = points[count / 2];
    Extent e { float(middle.x), float(middle.y), float(middle.x), float(middle.y), float(middle.x), float(middle.y) };
    for (Index i = 0; i < count; ++i) {
        e.x0 = std::min(e.x0, float(points[i].x) - reach), e.x1 = std::max(e.x1, float(points[i].x) + reach);
        e.y0 = std::min(e.y0, float(points[i].y) - reach), e.y1 = std::max(e.y1, float(points[i].y) + reach);
    }
    return e;
}

bool is_inside(const Wrap& wrap, const Extent& e, float overlap)
{
    const auto inside = [&](float at, int margin, int size) {
        return margin == 0
            || (at >= float(margin) - 0.5f - overlap && at < float(margin) - 0.5f + float(size) + overlap);
    };
    return inside(e.middle_x, wrap.margin_x, wrap.width) && inside(e.middle_y, wrap.margin_y, wrap.height);
}

/// Calls draw(dx, dy) for all that a mark is moved by where it shows: a period to either side, or not at all.
template<class Draw>
void for_repeats(const Wrap& wrap, const Extent& e, Draw&& draw)
{
    const auto shows = [](float first, float last, int margin, int size) {
        return last >= float(margin) - kNear && first < float(margin + size) + kNear;
    };
    const int across = wrap.margin_x > 0 ? 1 : 0, down = wrap.margin_y > 0 ? 1 : 0;
    for (int j = -down; j <= down; ++j)
        for (int i = -across; i <= across; ++i) {
            const float dx = float(i * wrap.width), dy = float(j * wrap.height);
            if (shows(e.x0 + dx, e.x1 + dx, wrap.margin_x, wrap.width)
                && shows(e.y0 + dy, e.y1 + dy, wrap.margin_y, wrap.height))
                draw(dx, dy);
        }
}

}  // namespace

void wrap_strokes(const Wrap& wrap, float overlap, Strokes& strokes, ShownColours& colours)
{
    if (!wrap)
        return;
    Strokes result { strokes.width, strokes.height, {}, {} };
    ShownColours result_colours(colours.size());
    for (std::size_t s = 0; s < strokes.strokes.size(); ++s) {
        const Stroke& stroke = strokes.strokes[s];
        const Vec2* points = strokes.begin(stroke);
        const Extent extent = extent_of(points, stroke.count, stroke.width);
        if (!is_inside(wrap, extent, overlap))
            continue;
        for_repeats(wrap, extent, [&](float dx, float dy) {
            Stroke repeat = stroke;
            repeat.first = Index(result.points.size());
            for (Index i = 0; i < stroke.count; ++i)
                result.points.push_back({ points[i].x + dx, points[i].y + dy });
            result.strokes.push_back(repeat);
            for (std::size_t c = 0; c < colours.size(); ++c)
                result_colours[c].push_back(colours[c][s]);
        });
    }
    strokes = std::move(result);
    colours = std::move(result_colours);
}

Strokes without_margins(const Wrap& wrap, Strokes strokes)
{
    if (!wrap)
        return strokes;
    strokes.width = wrap.width;
    strokes.height = wrap.height;
    for (Vec2& point : strokes.points)
        point = { point.x - float(wrap.margin_x), point.y - float(wrap.margin_y) };
    return strokes;
}

Drawing wrapped_drawing(const Wrap& wrap, const Drawing& drawing)
{
    if (!wrap)
        return drawing;
    Drawing result { wrap.width, wrap.height, drawing.inks, {}, {} };
    for (const InkLine& line : drawing.lines) {
        const InkPoint* points = drawing.begin(line);
        float widest = 0.0f;
        for (Index i = 0; i < line.count; ++i)
            widest = std::max(widest, points[i].width);
        const Extent extent = extent_of(points, line.count, 0.5f * widest);
        if (!is_inside(wrap, extent, 0.0f))
            continue;
        for_repeats(wrap, extent, [&](float dx, float dy) {
            result.lines.push_back({ Index(result.points.size()), line.count, line.ink });
            for (Index i = 0; i < line.count; ++i)
                result.points.push_back({ points[i].x + dx - float(wrap.margin_x),
                                          points[i].y + dy - float(wrap.margin_y), points[i].width });
        });
    }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
