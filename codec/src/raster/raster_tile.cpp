// SPDX-License-Identifier: BSD-3-Clause
#include "raster/raster_tile.h"

#include <algorithm>
#include <array>

#include "entropy/binary_coder.h"
#include "entropy/symbol_coder.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

std::int64_t size(std::int64_t v)
{
    return v < 0 ? -v : v;
}

/// W + N - NW kept between W and N: follows edges in either direction (LOCO-I, Weinberger et al. 2000).
std::int64_t median(std::int64_t w, std::int64_t n, std::int64_t nw)
{
    // min(w - n, 0). A processor cannot predict which of the two is less, so there is no branch.
    const std::int64_t under = (w - n) & ((w - n) >> 63);
    return std::max(n + under, std::min(w + n - nw, w - under));
}

template<Shape Predicted>
std::int64_t predict(std::int64_t w, std::int64_t n, std::int64_t nw, std::int64_t ne)
{
    if constexpr (Predicted == Shape::none)
        return 0;
    else if constexpr (Predicted == Shape::left)
        return w;
    else if constexpr (Predicted == Shape::median)
        return median(w, n, nw);
    else
        return (6 * w + 5 * n - 4 * nw + ne + 4) >> 3;
}

/// Visits the samples in row order with the prediction and the class of the next residual. The class does not depend on
/// the sample to the left, so that a processor can find it while that sample is still being decoded. visit(at,
/// prediction, class) sets values[at] and returns the size of the residual.
template<Shape Predicted, bool OverMesh, class Visit>
void walk(const TileChannel& t, Visit&& visit)
{
    const std::size_t up = std::size_t(t.width);
    const std::int32_t *const values = t.values, *const mesh = t.gouraud;
    const std::uint16_t* const guide = t.guide;
    std::uint16_t* const sizes = t.sizes;
    const auto difference = [=](std::size_t at) {
        if constexpr (OverMesh)
            return std::int64_t(values[at]) - mesh[at];
        else
            return std::int64_t(values[at]);
    };
    const auto row = [&](std::size_t at, auto is_first) {
        constexpr bool kFirst = decltype(is_first)::value;
        std::int64_t w = 0, ww = 0, n = 0, nw = 0, ne = 0, size_w = 0, size_ww = 0;
        if constexpr (!kFirst) {
            w = ww = n = nw = difference(at - up);
            size_w = size_ww = sizes[at - up];
        }
        for (const std::size_t end = at + up; at < end; ++at) {
            std::int64_t busy = 0;
            if constexpr (kFirst) {
                n = nw = ne = w;
                busy = 4 * size_ww;
            } else {
                ne = at + 1 < end ? difference(at - up + 1) : n;
                busy = size(ww - nw) + size(n - nw) + size(n - ne) + size_ww + 2 * std::int64_t(sizes[at - up])
                    + sizes[at - up + (at + 1 < end)];
            }
            if (guide)
                busy += 2 * std::int64_t(guide[at]);
            const std::uint32_t symbol_class = class_of(std::uint32_t(std::min<std::int64_t>(busy, 0xffffffffll)));
            const std::int64_t base = OverMesh ? std::int64_t(mesh[at]) : 0;
            const std::uint32_t residual_size = visit(at, base + predict<Predicted>(w, n, nw, ne), symbol_class);
            size_ww = size_w;
            size_w = std::min<std::uint32_t>(residual_size, 65535);
            sizes[at] = std::uint16_t(size_w);
            ww = w;
            w = difference(at);
            nw = n;
            n = ne;
        }
    };
    row(0, std::true_type());
    for (int y = 1; y < t.height; ++y)
        row(std::size_t(y) * up, std::false_type());
}

template<class Visit>
void walk(const TileChannel& t, TilePredictor p, Visit&& visit)
{
    const auto with = [&](auto shape) {
        if (p.gouraud)
            walk<decltype(shape)::value, true>(t, visit);
        else
            walk<decltype(shape)::value, false>(t, visit);
    };
    switch (p.shape) {
    case Shape::none:
        return with(std::integral_constant<Shape, Shape::none>());
    case Shape::left:
        return with(std::integral_constant<Shape, Shape::left>());
    case Shape::median:
        return with(std::integral_constant<Shape, Shape::median>());
    case Shape::mean:
        return with(std::integral_constant<Shape, Shape::mean>());
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

std::uint64_t estimate_tile_channel(const TileChannel& channel, TilePredictor predictor)
{
    std::vector<std::array<std::uint32_t, kTokens>> counts(kClasses, std::array<std::uint32_t, kTokens> {});
    std::uint64_t bits = 0;
    walk(channel, predictor, [&](std::size_t at, std::int64_t prediction, std::uint32_t symbol_class) {
        const std::uint32_t v = folded(channel.values[at], prediction);
        const Token t = token_of(v);
        ++counts[symbol_class][t.token];
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

void write_tile_channel(const TileChannel& channel, TilePredictor predictor, Bytes& out)
{
    SymbolWriter symbols;
    symbols.reserve(channel.pixels());
    std::vector<std::uint32_t> residuals;
    residuals.reserve(channel.pixels());
    std::uint32_t largest = 0;
    walk(channel, predictor, [&](std::size_t at, std::int64_t prediction, std::uint32_t symbol_class) {
        const std::uint32_t v = folded(channel.values[at], prediction);
        symbols.add(symbol_class, v);
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
    put_u8(out,
           std::uint32_t(predictor.shape) | (predictor.gouraud ? 4u : 0u)
               | (planar ? std::uint32_t(kPlanes) : std::uint32_t(kSymbols)) << 4);
    if (planar) {
        put_u8(out, std::uint32_t(planes));
        put_varint(out, packed.size());
        put_bytes(out, packed.data(), packed.size());
    } else
        put_bytes(out, coded.data(), coded.size());
}

bool TileChannelReader::open(ByteReader& in, std::size_t pixels)
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

bool TileChannelReader::read(const TileChannel& channel)
{
    if (m_predictor.gouraud && !channel.gouraud)
        return false;
    const auto each = [&](auto&& number) {
        walk(channel, m_predictor, [&](std::size_t at, std::int64_t prediction, std::uint32_t symbol_class) {
            const std::uint32_t v = number(at, symbol_class);
            channel.values[at] = restored(v, prediction);
            return size_of_folded(v);
        });
    };
    if (m_planar) {
        const std::size_t pixels = channel.pixels();
        each([&](std::size_t at, std::uint32_t) {
            std::uint32_t v = 0;
            for (std::uint32_t k = m_planes; k-- > 0;)
                v = v << 8 | m_bytes[k * pixels + at];
            return v;
        });
        return true;
    }
    SymbolCursor cursor = m_symbols.cursor();
    each([&](std::size_t, std::uint32_t symbol_class) { return cursor.next(symbol_class); });
    m_symbols.set_cursor(cursor);
    return m_symbols.finished();
}

}  // namespace PIMG_ABI
}  // namespace pimg
