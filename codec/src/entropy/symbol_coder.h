// SPDX-License-Identifier: BSD-3-Clause
// Static range coder (rANS, Duda 2013) for what is large: raster residuals and the collapse sequence. Every number
// comes with a class the reader already knows (how busy it is there). Neighbouring classes are joined into contexts, as
// many as pay for their tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "entropy/bytes.h"

namespace pimg {
inline namespace PIMG_ABI {

// Sizes of the tables: docs/format.md, section 3.2.
constexpr int kProbabilityBits = 11;
constexpr std::uint32_t kProbabilities = 1u << kProbabilityBits;  ///< frequencies of a context add up to this
constexpr std::uint32_t kStateLow = 1u << 16;                     ///< states stay in [2^16, 2^32)
constexpr std::uint32_t kTokens = 72;
constexpr std::uint32_t kClasses = 96;
constexpr std::uint32_t kMaxContexts = 24;

/// Half-octave class of a magnitude: 0 1 2 3 4-5 6-7 8-11 12-15 ... at most 63.
inline std::uint32_t class_of(std::uint32_t v)
{
    // Without branches: classes are hard to predict.
    const int n = 31 - __builtin_clz(v | 1);
    return std::uint32_t(2 * n) + std::uint32_t(std::uint64_t(v) << 1 >> n & 1) + std::uint32_t(v == 1);
}

/// A number is a token and `extra` further bits: numbers under 16 are their own token.
struct Token {
    std::uint32_t token;
    int extra;
};

inline Token token_of(std::uint32_t v)
{
    if (v < 16)
        return { v, 0 };
    const int n = 31 - __builtin_clz(v);
    return { std::uint32_t(16 + (n - 4) * 2) + (v >> (n - 1) & 1), n - 1 };
}

class SymbolWriter {
public:
    void reserve(std::size_t count) { m_symbols.reserve(count); }
    void add(std::uint32_t symbol_class, std::uint32_t value)
    {
        m_symbols.push_back({ value, std::uint8_t(symbol_class) });
    }
    std::size_t count() const { return m_symbols.size(); }
    /// Writes the stream and forgets the symbols.
    Bytes finish();

private:
    struct Symbol {
        std::uint32_t value;
        std::uint8_t symbol_class;
    };
    std::vector<Symbol> m_symbols;
};

/// Frequency table of one context, ready for reading.
struct SymbolTable {
    struct Range {
        std::uint16_t frequency, start;
    };
    std::array<std::uint8_t, kProbabilities> token;
    std::array<Range, kTokens> range;
};

/// The part of a SymbolReader that changes while it reads. Loops copy it to a local variable, which can live in
/// registers. There are no branches on data; past the ends of the stream it reads padding and goes on counting.
struct SymbolCursor {
    const SymbolTable* const* table_of = nullptr;  ///< by class
    const std::uint16_t* words = nullptr;
    const std::uint8_t* raw = nullptr;
    std::size_t word = 0, word_count = 0;
    std::uint64_t bit = 0, raw_size = 0;
    std::uint32_t state[2] = { kStateLow, kStateLow };

    std::uint32_t next(std::uint32_t symbol_class)
    {
        const SymbolTable& table = *table_of[symbol_class];
        const std::uint32_t x = state[0], slot = x & (kProbabilities - 1);
        const std::uint32_t token = table.token[slot];
        const SymbolTable::Range range = table.range[token];
        std::uint32_t y = range.frequency * (x >> kProbabilityBits) + slot - range.start;
        const std::uint32_t low = y < kStateLow;  // unpredictable, hence arithmetic in place of a branch
        y = y << (16 * low) | (words[word < word_count ? word : word_count] & (0u - low));
        word += low;
        state[0] = state[1];
        state[1] = y;
        const TokenBits t = kTokenBits.of[token];
        const std::uint64_t byte = bit >> 3;
        const std::uint64_t window = load_u64(raw + (byte < raw_size ? byte : raw_size)) >> (bit & 7);
        bit += t.extra;
        return t.base + (std::uint32_t(window) & t.mask);
    }

private:
    struct TokenBits {
        std::uint32_t base, mask, extra;
    };
    struct TokenTable {
        std::array<TokenBits, kTokens> of {};
        constexpr TokenTable()
        {
            for (std::uint32_t t = 0; t < kTokens; ++t) {
                const std::uint32_t extra = t < 16 ? 0 : (t - 16) / 2 + 3;
                of[t] = { t < 16 ? t : (2 + (t & 1)) << extra, (1u << extra) - 1, extra };
            }
        }
    };
    static const TokenTable kTokenBits;
};
inline constexpr SymbolCursor::TokenTable SymbolCursor::kTokenBits {};

class SymbolReader {
public:
    SymbolReader() = default;
    SymbolReader(const SymbolReader&) = delete;
    SymbolReader& operator=(const SymbolReader&) = delete;

    /// Reads the tables and takes the rest of the stream; false when it is damaged.
    bool open(ByteReader& in);
    std::uint32_t next(std::uint32_t symbol_class) { return m_cursor.next(symbol_class); }

    SymbolCursor cursor() const { return m_cursor; }
    void set_cursor(const SymbolCursor& cursor) { m_cursor = cursor; }

    /// Whether all of the stream was read, and nothing past its end.
    bool finished() const;

private:
    bool read_tables(const std::uint8_t* data, std::size_t size);

    std::array<const SymbolTable*, kClasses> m_table_of {};
    std::vector<SymbolTable> m_tables;
    std::vector<std::uint16_t> m_words;  ///< and one word of padding
    Bytes m_raw;                         ///< and eight bytes of padding
    SymbolCursor m_cursor;
};

/// log2(v) in 1/256 bits, v >= 1: the measure of every choice a writer makes, in integers so that files do not depend
/// on a machine's mathematics.
std::uint32_t log2_fixed(std::uint32_t v);

}  // namespace PIMG_ABI
}  // namespace pimg
