// SPDX-License-Identifier: BSD-3-Clause
#include "source/wrap/wrapped_pieces.h"

#include <limits>

#include <pimg/dual_pieces.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Chooses among the places that show a pixel.
class PlaceFinder {
public:
    PlaceFinder(const Wrap& wrap, const std::vector<Index>& labels, Index count)
        : m_wrap(wrap),
          m_labels(labels),
          m_middles(label_centroids(labels, count, wrap.padded_width()))
    {
    }

    /// kGhost if no piece with its middle in the picture has the pixel.
    Index find(int x, int y) const
    {
        const Fade across = fade_at(x, m_wrap.width, m_wrap.margin_x),
                   down = fade_at(y, m_wrap.height, m_wrap.margin_y);
        Index best = kGhost;
        float least = std::numeric_limits<float>::max();
        const auto try_place = [&](int px, int py) {
            const Index place = m_wrap.place(px, py);
            const Centroid middle = m_middles[m_labels[place]];
            const float mx = middle.x - float(m_wrap.margin_x), my = middle.y - float(m_wrap.margin_y);
            const bool inside =
                mx >= -0.5f && my >= -0.5f && mx < float(m_wrap.width) - 0.5f && my < float(m_wrap.height) - 0.5f;
            const float away = (mx - float(px)) * (mx - float(px)) + (my - float(py)) * (my - float(py));
            if (inside && away < least) {
                least = away;
                best = place;
            }
        };
        try_place(x, y);
        if (across.share > 0.0f)
            try_place(across.other, y);
        if (down.share > 0.0f)
            try_place(x, down.other);
        if (across.share > 0.0f && down.share > 0.0f)
            try_place(across.other, down.other);
        return best;
    }

private:
    const Wrap& m_wrap;
    const std::vector<Index>& m_labels;
    std::vector<Centroid> m_middles;
};

/// Gives pixels without a place that of a neighbour, layer by layer.
void spread(const Wrap& wrap, std::vector<Index>& places)
{
    const auto number = [&](int x, int y) {
        return Index(modulo(y, wrap.height)) * Index(wrap.width) + Index(modulo(x, wrap.width));
    };
    std::vector<Index> layer, next;
    for (Index p = 0; p < Index(places.size()); ++p)
        if (places[p] != kGhost)
            layer.push_back(p);
    if (layer.empty())
        places[0] = wrap.place(0, 0), layer.push_back(0);
    for (; !layer.empty(); layer.swap(next)) {
        next.clear();
        for (const Index p : layer) {
            const int x = int(p % Index(wrap.width)), y = int(p / Index(wrap.width));
            for (const Index q : { number(x, y - 1), number(x - 1, y), number(x + 1, y), number(x, y + 1) })
                if (places[q] == kGhost) {
                    places[q] = places[p];
                    next.push_back(q);
                }
        }
    }
}

}  // namespace

std::vector<Index> piece_places(const Wrap& wrap, const std::vector<Index>& labels, Index count)
{
    const PlaceFinder finder(wrap, labels, count);
    std::vector<Index> places;
    places.reserve(wrap.pixels());
    for (int y = 0; y < wrap.height; ++y)
        for (int x = 0; x < wrap.width; ++x)
            places.push_back(finder.find(x, y));
    spread(wrap, places);
    return places;
}

std::vector<Index> wrapped_pieces(const Wrap& wrap, const std::vector<Index>& labels, Index& count)
{
    if (!wrap)
        return labels;
    std::vector<Index> result = piece_places(wrap, labels, count), number(count, kGhost);
    count = 0;
    for (Index& place : result) {
        Index& label = number[labels[place]];
        if (label == kGhost)
            label = count++;
        place = label;
    }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
