// SPDX-License-Identifier: BSD-3-Clause
// Static range coder (rANS, Duda 2013) for what is large: raster residuals and the collapse sequence. Every number comes
// with a class the reader already knows (how busy it is there). Neighbouring classes are joined into contexts, as many
// as pay for their tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec_bytes.h"

namespace pimg {

constexpr int kProbabilityBits = 11;
constexpr std::uint32_t kProbabilities = 1u << kProbabilityBits;  ///< frequencies of a context add up to this
constexpr std::uint32_t kStateLow = 1u << 16;                     ///< states stay in [2^16, 2^32)
constexpr std::uint32_t kTokens = 72;
constexpr std::uint32_t kClasses = 96;
constexpr std::uint32_t kMaxContexts = 24;

/// Half-octave class of a magnitude: 0 1 2 3 4-5 6-7 8-11 12-15 ... at most 63.
inline std::uint32_t class_of(std::uint32_t v)
{
    if (v < 4)
        return v;
    const int n = 31 - __builtin_clz(v);
    return std::uint32_t(2 * n) + (v >> (n - 1) & 1);
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
    void add(std::uint32_t klass, std::uint32_t value) { m_symbols.push_back({ value, std::uint8_t(klass) }); }
    std::size_t count() const { return m_symbols.size(); }
    /// Writes the stream and forgets the symbols.
    Bytes finish();

private:
    struct Symbol {
        std::uint32_t value;
        std::uint8_t klass;
    };
    std::vector<Symbol> m_symbols;
};

class SymbolReader {
public:
    /// Reads the tables and takes the rest of the stream; false when it is damaged. The bytes must stay alive.
    bool open(ByteReader& in);

    std::uint32_t next(std::uint32_t klass)
    {
        const std::uint32_t context = m_context_of[klass];
        const Table& table = m_tables[context];
        const std::uint32_t state = m_state[0], slot = state & (kProbabilities - 1);
        const std::uint32_t token = table.token[slot];
        std::uint32_t next = table.range[token].frequency * (state >> kProbabilityBits) + slot - table.range[token].start;
        if (next < kStateLow)
            next = next << 16 | pull();
        m_state[0] = m_state[1];
        m_state[1] = next;
        if (token < 16)
            return token;
        const int extra = int(token - 16) / 2 + 3;
        const std::uint32_t high = 2 + ((token - 16) & 1);
        return high << extra | bits(extra);
    }

    /// Whether everything was read and nothing more.
    bool finished() const;
    /// Whether it read past the end; the numbers since then mean nothing.
    bool overrun() const { return m_over; }

private:
    struct Range {
        std::uint16_t frequency, start;
    };
    struct Table {
        std::array<std::uint8_t, kProbabilities> token;
        std::array<Range, kTokens> range;
    };

    bool read_tables(const std::uint8_t* data, std::size_t size);

    std::uint32_t pull()
    {
        if (m_words_left == 0) {
            m_over = true;
            return 0;
        }
        const std::uint32_t word = load_u16(m_words);
        m_words += 2;
        --m_words_left;
        return word;
    }

    std::uint32_t bits(int count)
    {
        if (m_bit + std::uint64_t(count) > m_bit_count) {
            m_over = true;
            return 0;
        }
        const std::size_t byte = std::size_t(m_bit >> 3);
        std::uint64_t v = 0;
        if (byte + 8 <= m_raw_size)
            v = load_u64(m_raw + byte);
        else
            for (std::size_t k = m_raw_size; k-- > byte;)
                v = v << 8 | m_raw[k];
        v >>= m_bit & 7;
        m_bit += std::uint64_t(count);
        return std::uint32_t(v & ((1ull << count) - 1));
    }

    std::array<std::uint8_t, kClasses> m_context_of {};
    std::vector<Table> m_tables;
    std::uint32_t m_state[2] = { kStateLow, kStateLow };
    const std::uint8_t* m_words = nullptr;
    std::size_t m_words_left = 0;
    const std::uint8_t* m_raw = nullptr;
    std::size_t m_raw_size = 0;
    std::uint64_t m_bit = 0, m_bit_count = 0;
    bool m_over = false;
};

/// log2(v) in 1/256 bits, v >= 1: the measure of every choice a writer makes, in integers so that files do not depend
/// on a machine's mathematics.
std::uint32_t log2_fixed(std::uint32_t v);

}  // namespace pimg
