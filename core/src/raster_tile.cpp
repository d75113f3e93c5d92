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

namespace {

bool read_symbols(ByteReader& in, const TilePlane& plane, TilePredictor predictor)
{
    SymbolReader symbols;
    if (!symbols.open(in))
        return false;
    SymbolCursor cursor = symbols.cursor();
    std::int32_t* const values = plane.values;
    walk(plane, predictor, [&cursor, values](std::size_t at, std::int64_t prediction, std::uint32_t klass) {
        const std::uint32_t v = cursor.next(klass);
        values[at] = restored(v, prediction);
        return size_of_folded(v);
    });
    symbols.set_cursor(cursor);
    return symbols.finished();
}

bool read_planes(ByteReader& in, const TilePlane& plane, TilePredictor predictor)
{
    const std::uint32_t planes = in.u8();
    const std::uint64_t packed = in.varint();
    if (planes < 1 || planes > 4 || packed > in.left())
        return false;
    const std::size_t n = plane.pixels();
    Bytes bytes(n * planes);
    if (!zstd_unpack(in.take(std::size_t(packed)), std::size_t(packed), bytes.data(), bytes.size()))
        return false;
    walk(plane, predictor, [&](std::size_t at, std::int64_t prediction, std::uint32_t) {
        std::uint32_t v = 0;
        for (std::uint32_t k = planes; k-- > 0;)
            v = v << 8 | bytes[k * n + at];
        plane.values[at] = restored(v, prediction);
        return size_of_folded(v);
    });
    return true;
}

}  // namespace

bool read_tile_plane(ByteReader& in, const TilePlane& plane)
{
    const std::uint32_t head = in.u8();
    const TilePredictor predictor { Shape(head & 3), (head & 4) != 0 };
    if (!in.ok() || (predictor.gouraud && !plane.gouraud) || (head & 8) != 0)
        return false;
    switch (head >> 4) {
    case kSymbols: return read_symbols(in, plane, predictor);
    case kPlanes: return read_planes(in, plane, predictor);
    default: return false;
    }
}

bool tile_plane_uses_gouraud(const ByteReader& in)
{
    return in.left() > 0 && (*in.here() & 4) != 0;
}

}  // namespace pimg
