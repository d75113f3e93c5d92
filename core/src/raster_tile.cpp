// SPDX-License-Identifier: BSD-3-Clause
#include "raster_tile.h"

#include <algorithm>
#include <array>

#include "binary_coder.h"
#include "symbol_coder.h"

namespace pimg {

namespace {

std::int64_t size(std::int64_t v)
{
    return v < 0 ? -v : v;
}

/// W + N - NW kept between W and N: follows edges in either direction (LOCO-I, Weinberger et al. 2000).
std::int64_t median(std::int64_t w, std::int64_t n, std::int64_t nw)
{
    const std::int64_t low = std::min(w, n), high = std::max(w, n);
    return std::clamp(w + n - nw, low, high);
}

template<Shape shape>
std::int64_t predict(std::int64_t w, std::int64_t n, std::int64_t nw, std::int64_t ne)
{
    if constexpr (shape == Shape::none)
        return 0;
    else if constexpr (shape == Shape::left)
        return w;
    else if constexpr (shape == Shape::median)
        return median(w, n, nw);
    else
        return (6 * w + 5 * n - 4 * nw + ne + 4) >> 3;
}

/// Visits the samples in row order with the prediction and the class of the residual to come.
/// visit(at, prediction, class) sets values[at] and returns the size of the residual.
template<Shape shape, bool gouraud, class Visit>
void walk(const TilePlane& t, Visit&& visit)
{
    const int width = t.width, height = t.height;
    const std::size_t up = std::size_t(width);
    const std::int32_t *const values = t.values, *const mesh = t.gouraud;
    const std::uint16_t* const guide = t.guide;
    std::uint16_t* const sizes = t.sizes;
    const auto difference = [values, mesh](std::size_t at) {
        if constexpr (gouraud)
            return std::int64_t(values[at]) - mesh[at];
        else
            return std::int64_t(values[at]);
    };
    std::size_t at = 0;
    for (int y = 0; y < height; ++y) {
        std::int64_t w = 0, n = 0, nw = 0, ne = 0;
        std::int64_t size_w = 0;
        if (y > 0) {
            n = difference(at - up);
            w = nw = n;
            size_w = sizes[at - up];
        }
        for (int x = 0; x < width; ++x, ++at) {
            std::int64_t size_n = size_w;
            if (y > 0) {
                ne = x + 1 < width ? difference(at - up + 1) : n;
                size_n = sizes[at - up];
            } else
                n = nw = ne = w;
            const std::int64_t base = gouraud ? std::int64_t(mesh[at]) : 0;
            std::int64_t busy = size(w - nw) + size(n - nw) + size(n - ne) + 2 * (size_w + size_n);
            if (guide)
                busy += 2 * std::int64_t(guide[at]);
            const std::uint32_t klass = class_of(std::uint32_t(std::min<std::int64_t>(busy, 0xffffffffll)));
            const std::uint32_t residual_size = visit(at, base + predict<shape>(w, n, nw, ne), klass);
            size_w = std::min<std::uint32_t>(residual_size, 65535);
            sizes[at] = std::uint16_t(size_w);
            w = difference(at);
            nw = n;
            n = ne;
        }
    }
}

template<class Visit>
void walk(const TilePlane& t, TilePredictor p, Visit&& visit)
{
    const auto with = [&](auto shape) {
        if (p.gouraud)
            walk<decltype(shape)::value, true>(t, visit);
        else
            walk<decltype(shape)::value, false>(t, visit);
    };
    switch (p.shape) {
    case Shape::none: return with(std::integral_constant<Shape, Shape::none>());
    case Shape::left: return with(std::integral_constant<Shape, Shape::left>());
    case Shape::median: return with(std::integral_constant<Shape, Shape::median>());
    case Shape::mean: return with(std::integral_constant<Shape, Shape::mean>());
    }
}

std::uint32_t folded(std::int32_t value, std::int64_t prediction)
{
    return fold(std::int32_t(std::uint32_t(value) - std::uint32_t(std::uint64_t(prediction))));
}

std::int32_t restored(std::uint32_t residual, std::int64_t prediction)
{
    return std::int32_t(std::uint32_t(std::uint64_t(prediction)) + std::uint32_t(unfold(residual)));
}

std::uint32_t size_of_folded(std::uint32_t v)
{
    return v / 2 + (v & 1);
}

enum Method : std::uint8_t { kSymbols = 0, kPlanes = 1 };

}  // namespace

std::uint64_t estimate_tile_plane(const TilePlane& plane, TilePredictor predictor)
{
    std::vector<std::array<std::uint32_t, kTokens>> counts(kClasses, std::array<std::uint32_t, kTokens> {});
    std::uint64_t bits = 0;
    walk(plane, predictor, [&](std::size_t at, std::int64_t prediction, std::uint32_t klass) {
        const std::uint32_t v = folded(plane.values[at], prediction);
        const Token t = token_of(v);
        ++counts[klass][t.token];
        bits += std::uint64_t(t.extra) * 256;
        return size_of_folded(v);
    });
    for (const auto& count : counts) {
        std::uint32_t total = 0;
        for (std::uint32_t c : count)
            total += c;
        for (std::uint32_t c : count)
            if (c > 0)
                bits += c * std::uint64_t(log2_fixed(total) - log2_fixed(c));
    }
    return bits;
}

void write_tile_plane(const TilePlane& plane, TilePredictor predictor, Bytes& out)
{
    SymbolWriter symbols;
    symbols.reserve(plane.pixels());
    std::vector<std::uint32_t> residuals;
    residuals.reserve(plane.pixels());
    std::uint32_t largest = 0;
    walk(plane, predictor, [&](std::size_t at, std::int64_t prediction, std::uint32_t klass) {
        const std::uint32_t v = folded(plane.values[at], prediction);
        symbols.add(klass, v);
        residuals.push_back(v);
        largest = std::max(largest, v);
        return size_of_folded(v);
    });
    const Bytes coded = symbols.finish();
    const int planes = std::max(1, (bit_length(largest) + 7) / 8);
    Bytes bytes, packed;
    bytes.reserve(residuals.size() * std::size_t(planes));
    for (int k = 0; k < planes; ++k)
        for (std::uint32_t v : residuals)
            put_u8(bytes, v >> (8 * k) & 255);
    const bool planar = zstd_pack(bytes.data(), bytes.size(), 6, packed) && packed.size() + 4 < coded.size();
    put_u8(out, std::uint32_t(predictor.shape) | (predictor.gouraud ? 4u : 0u)
                    | (planar ? std::uint32_t(kPlanes) : std::uint32_t(kSymbols)) << 4);
    if (planar) {
        put_u8(out, std::uint32_t(planes));
        put_varint(out, packed.size());
        put_bytes(out, packed.data(), packed.size());
    } else
        put_bytes(out, coded.data(), coded.size());
}

/// One channel being decoded. What walk() keeps in variables is here for each.
struct TilePlaneReader::Lane {
    SymbolCursor cursor;
    Shape shape;
    std::int32_t* values;
    const std::int32_t* mesh;
    const std::uint16_t* guide;
    std::uint16_t* sizes;
    const std::uint8_t* bytes;  ///< of the planar method, or nullptr
    std::uint32_t planes;
    std::int64_t w, n, nw, ne, size_w;

    std::int64_t difference(std::size_t at) const { return std::int64_t(values[at]) - (mesh ? mesh[at] : 0); }

    std::uint32_t number(std::size_t at, std::size_t pixels, std::uint32_t klass)
    {
        if (!bytes)
            return cursor.next(klass);
        std::uint32_t v = 0;
        for (std::uint32_t k = planes; k-- > 0;)
            v = v << 8 | bytes[k * pixels + at];
        return v;
    }

    std::int64_t prediction() const
    {
        switch (shape) {
        case Shape::none: return predict<Shape::none>(w, n, nw, ne);
        case Shape::left: return predict<Shape::left>(w, n, nw, ne);
        case Shape::median: return predict<Shape::median>(w, n, nw, ne);
        case Shape::mean: return predict<Shape::mean>(w, n, nw, ne);
        }
        return 0;
    }
};

/// The same order of things as in walk(), for several channels at once.
template<int count>
void TilePlaneReader::read_lanes(Lane* lanes, const TilePlane& tile)
{
    const int width = tile.width, height = tile.height;
    const std::size_t up = std::size_t(width), pixels = tile.pixels();
    std::size_t at = 0;
    for (int y = 0; y < height; ++y) {
        for (int c = 0; c < count; ++c) {
            Lane& l = lanes[c];
            l.w = l.n = l.nw = l.ne = l.size_w = 0;
            if (y > 0) {
                l.w = l.n = l.nw = l.difference(at - up);
                l.size_w = l.sizes[at - up];
            }
        }
        for (int x = 0; x < width; ++x, ++at)
            for (int c = 0; c < count; ++c) {
                Lane& l = lanes[c];
                std::int64_t size_n = l.size_w;
                if (y > 0) {
                    l.ne = x + 1 < width ? l.difference(at - up + 1) : l.n;
                    size_n = l.sizes[at - up];
                } else
                    l.n = l.nw = l.ne = l.w;
                std::int64_t busy
                    = size(l.w - l.nw) + size(l.n - l.nw) + size(l.n - l.ne) + 2 * (l.size_w + size_n);
                if (l.guide)
                    busy += 2 * std::int64_t(l.guide[at]);
                const std::uint32_t v
                    = l.number(at, pixels, class_of(std::uint32_t(std::min<std::int64_t>(busy, 0xffffffffll))));
                const std::int64_t base = l.mesh ? std::int64_t(l.mesh[at]) : 0;
                const std::int32_t value = restored(v, base + l.prediction());
                l.values[at] = value;
                l.size_w = std::min<std::uint32_t>(size_of_folded(v), 65535);
                l.sizes[at] = std::uint16_t(l.size_w);
                l.w = std::int64_t(value) - base;
                l.nw = l.n;
                l.n = l.ne;
            }
    }
}

bool TilePlaneReader::open(ByteReader& in, std::size_t pixels)
{
    const std::uint32_t head = in.u8();
    m_predictor = { Shape(head & 3), (head & 4) != 0 };
    m_planar = head >> 4 == kPlanes;
    if (!in.ok() || (head & 8) != 0 || head >> 4 > kPlanes)
        return false;
    if (!m_planar)
        return m_symbols.open(in);
    m_planes = in.u8();
    const std::uint64_t packed = in.varint();
    if (m_planes < 1 || m_planes > 4 || packed > in.left())
        return false;
    m_bytes.resize(pixels * m_planes);
    return zstd_unpack(in.take(std::size_t(packed)), std::size_t(packed), m_bytes.data(), m_bytes.size());
}

bool TilePlaneReader::read(TilePlaneReader* readers, const TilePlane* planes, int count)
{
    Lane lanes[kLanes];
    for (int c = 0; c < count; ++c) {
        const TilePlaneReader& r = readers[c];
        const bool gouraud = r.m_predictor.gouraud;
        if (gouraud && !planes[c].gouraud)
            return false;
        lanes[c] = { r.m_symbols.cursor(), r.m_predictor.shape, planes[c].values, gouraud ? planes[c].gouraud : nullptr,
                     planes[c].guide, planes[c].sizes, r.m_planar ? r.m_bytes.data() : nullptr, r.m_planes,
                     0, 0, 0, 0, 0 };
    }
    switch (count) {
    case 1: read_lanes<1>(lanes, planes[0]); break;
    case 2: read_lanes<2>(lanes, planes[0]); break;
    default: read_lanes<3>(lanes, planes[0]);
    }
    for (int c = 0; c < count; ++c) {
        readers[c].m_symbols.set_cursor(lanes[c].cursor);
        if (!readers[c].m_planar && !readers[c].m_symbols.finished())
            return false;
    }
    return true;
}

}  // namespace pimg
