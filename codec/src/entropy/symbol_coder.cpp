// SPDX-License-Identifier: BSD-3-Clause
#include "entropy/symbol_coder.h"

#include <algorithm>
#include <cmath>

#include "entropy/binary_coder.h"

namespace pimg {
inline namespace PIMG_ABI {

std::uint32_t log2_fixed(std::uint32_t v)
{
    static const std::array<std::uint16_t, 257> fraction = [] {
        std::array<std::uint16_t, 257> t {};
        for (std::size_t i = 0; i < t.size(); ++i)
            t[i] = std::uint16_t(std::lround(256.0 * std::log2(1.0 + double(i) / 256.0)));
        return t;
    }();
    const int n = 31 - __builtin_clz(v);
    const std::uint32_t mantissa = n >= 8 ? v >> (n - 8) & 255 : v << (8 - n) & 255;
    return std::uint32_t(n) * 256 + fraction[mantissa];
}

namespace {

/// How often each token occurs in a class or context.
struct Histogram {
    std::array<std::uint32_t, kTokens> count {};
    std::uint32_t total = 0;

    void add(const Histogram& other)
    {
        for (std::size_t t = 0; t < kTokens; ++t)
            count[t] += other.count[t];
        total += other.total;
    }
    /// Bits, in 1/256, of coding the tokens and the table.
    std::uint64_t cost() const
    {
        if (total == 0)
            return 0;
        const std::uint64_t whole = log2_fixed(total);
        std::uint64_t bits = 8 * 256;
        for (std::uint32_t c : count)
            if (c > 0)
                bits += c * (whole - log2_fixed(c)) + 6 * 256;
        return bits;
    }
};

struct Context {
    Histogram histogram;
    std::uint32_t last_class;
    std::uint64_t cost;
};

/// Joins neighbouring classes as long as that saves bits.
std::vector<Context> join_classes(const std::vector<Histogram>& classes)
{
    std::vector<Context> contexts;
    for (std::uint32_t k = 0; k < classes.size(); ++k)
        if (classes[k].total > 0)
            contexts.push_back({ classes[k], k, classes[k].cost() });
    if (contexts.empty())
        contexts.push_back({ {}, 0, 0 });
    const auto joined = [&](std::size_t i) {
        Histogram h = contexts[i].histogram;
        h.add(contexts[i + 1].histogram);
        return h;
    };
    // saving[i]: bits saved by joining contexts i and i + 1; may be negative.
    std::vector<std::int64_t> saving(contexts.size());
    const auto measure = [&](std::size_t i) {
        saving[i] = std::int64_t(contexts[i].cost + contexts[i + 1].cost) - std::int64_t(joined(i).cost());
    };
    for (std::size_t i = 0; i + 1 < contexts.size(); ++i)
        measure(i);
    while (contexts.size() > 1) {
        const std::size_t best = std::size_t(
            std::max_element(saving.begin(), saving.begin() + std::ptrdiff_t(contexts.size()) - 1) - saving.begin());
        if (saving[best] < 0 && contexts.size() <= kMaxContexts)
            break;
        Histogram h = joined(best);
        const std::uint64_t cost = h.cost();
        contexts[best] = { h, contexts[best + 1].last_class, cost };
        contexts.erase(contexts.begin() + std::ptrdiff_t(best) + 1);
        saving.erase(saving.begin() + std::ptrdiff_t(best));
        if (best + 1 < contexts.size())
            measure(best);
        if (best > 0)
            measure(best - 1);
    }
    return contexts;
}

/// Frequencies that add up to kProbabilities, at least 1 for every token that occurs.
std::array<std::uint32_t, kTokens> frequencies(const Histogram& h)
{
    std::array<std::uint32_t, kTokens> f {};
    if (h.total == 0) {
        f[0] = kProbabilities;
        return f;
    }
    std::int64_t left = kProbabilities;
    for (std::size_t t = 0; t < kTokens; ++t)
        if (h.count[t] > 0) {
            f[t] = std::max<std::uint32_t>(
                1, std::uint32_t((std::uint64_t(h.count[t]) * kProbabilities + h.total / 2) / h.total));
            left -= f[t];
        }
    // What rounding left over or took too much is made up where it costs least: at the most frequent tokens.
    while (left != 0) {
        const auto most = std::max_element(f.begin(), f.end());
        const std::int64_t step = left > 0 ? left : std::max<std::int64_t>(left, -std::int64_t(*most / 4));
        *most = std::uint32_t(std::int64_t(*most) + step);
        left -= step;
    }
    return f;
}

constexpr std::uint32_t kLengthModels = kProbabilityBits + 2;  ///< one for each length in bits of the frequency before

Bytes write_tables(const std::vector<Context>& contexts, const std::vector<std::array<std::uint32_t, kTokens>>& tables)
{
    BinaryWriter out;
    NumberModel model[kLengthModels];
    out.direct(std::uint32_t(contexts.size()), 5);
    for (std::size_t i = 0; i < contexts.size(); ++i) {
        if (i + 1 < contexts.size())
            out.direct(contexts[i].last_class, 7);
        std::uint32_t used = kTokens;
        while (tables[i][used - 1] == 0)
            --used;
        out.direct(used, 7);
        std::uint32_t before = 0;
        for (std::uint32_t t = 0; t + 1 < used; ++t) {
            model[bit_length(before)].write(out, tables[i][t]);
            before = tables[i][t];
        }
    }
    return out.finish();
}

class BitWriter {
public:
    void put(std::uint32_t value, int count)
    {
        m_bits |= std::uint64_t(value) << m_count;
        for (m_count += count; m_count >= 8; m_count -= 8, m_bits >>= 8)
            put_u8(m_out, m_bits & 255);
    }
    Bytes finish()
    {
        if (m_count > 0)
            put_u8(m_out, m_bits & 255);
        return std::move(m_out);
    }

private:
    std::uint64_t m_bits = 0;
    int m_count = 0;
    Bytes m_out;
};

/// The stream: three lengths, tables, the two states, words from the last to the first, extra bits.
Bytes joined(const Bytes& tables, const std::vector<std::uint16_t>& words, const std::uint32_t (&state)[2],
             const Bytes& raw)
{
    Bytes out;
    put_varint(out, tables.size());
    put_varint(out, words.size());
    put_varint(out, raw.size());
    put_bytes(out, tables.data(), tables.size());
    put_u32(out, state[0]);
    put_u32(out, state[1]);
    for (std::size_t i = words.size(); i-- > 0;)
        put_u16(out, words[i]);
    put_bytes(out, raw.data(), raw.size());
    return out;
}

}  // namespace

Bytes SymbolWriter::finish()
{
    std::vector<Histogram> classes(kClasses);
    BitWriter raw;
    for (const Symbol& s : m_symbols) {
        const Token t = token_of(s.value);
        ++classes[s.symbol_class].count[t.token];
        ++classes[s.symbol_class].total;
        if (t.extra > 0)
            raw.put(s.value & ((1u << t.extra) - 1), t.extra);
    }
    const std::vector<Context> contexts = join_classes(classes);
    std::vector<std::array<std::uint32_t, kTokens>> tables, starts;
    std::array<std::uint8_t, kClasses> context_of {};
    std::uint32_t symbol_class = 0;
    for (std::size_t i = 0; i < contexts.size(); ++i) {
        for (; symbol_class <= contexts[i].last_class || (i + 1 == contexts.size() && symbol_class < kClasses);
             ++symbol_class)
            context_of[symbol_class] = std::uint8_t(i);
        tables.push_back(frequencies(contexts[i].histogram));
        starts.push_back({});
        for (std::size_t t = 1; t < kTokens; ++t)
            starts[i][t] = starts[i][t - 1] + tables[i][t - 1];
    }

    // Last symbol first: the reader meets them in order. Two states take turns.
    std::vector<std::uint16_t> words;
    std::uint32_t state[2] = { kStateLow, kStateLow };
    for (std::size_t n = m_symbols.size(); n-- > 0;) {
        const std::uint32_t token = token_of(m_symbols[n].value).token;
        const std::size_t i = context_of[m_symbols[n].symbol_class];
        const std::uint32_t f = tables[i][token];
        std::uint32_t& x = state[n & 1];
        if (x >= std::uint64_t(f) << (32 - kProbabilityBits)) {
            words.push_back(std::uint16_t(x));
            x >>= 16;
        }
        x = x / f * kProbabilities + x % f + starts[i][token];
    }

    m_symbols.clear();
    return joined(write_tables(contexts, tables), words, state, raw.finish());
}

bool SymbolReader::open(ByteReader& in)
{
    const std::uint64_t tables = in.varint(), words = in.varint(), raw = in.varint();
    if (!in.ok() || tables > in.left() || words > in.left() / 2 || raw > in.left())
        return false;
    const std::uint8_t* table_bytes = in.take(std::size_t(tables));
    if (!table_bytes || !read_tables(table_bytes, std::size_t(tables)))
        return false;
    SymbolCursor& c = m_cursor;
    c = {};
    c.state[0] = in.u32();
    c.state[1] = in.u32();
    const std::uint8_t* word_bytes = in.take(std::size_t(words) * 2);
    const std::uint8_t* raw_bytes = in.take(std::size_t(raw));
    if (!in.ok() || c.state[0] < kStateLow || c.state[1] < kStateLow)
        return false;
    m_words.assign(std::size_t(words) + 1, 0);
    for (std::size_t i = 0; i < std::size_t(words); ++i)
        m_words[i] = std::uint16_t(load_u16(word_bytes + 2 * i));
    m_raw.assign(raw_bytes, raw_bytes + raw);
    m_raw.resize(m_raw.size() + 8);
    c.table_of = m_table_of.data();
    c.words = m_words.data();
    c.word_count = std::size_t(words);
    c.raw = m_raw.data();
    c.raw_size = raw;
    return true;
}

bool SymbolReader::read_tables(const std::uint8_t* data, std::size_t size)
{
    BinaryReader in(data, size);
    NumberModel model[kLengthModels];
    const std::uint32_t contexts = in.direct(5);
    if (contexts < 1 || contexts > kMaxContexts)
        return false;
    m_tables.resize(contexts);
    std::uint32_t symbol_class = 0;
    for (std::uint32_t i = 0; i < contexts; ++i) {
        const std::uint32_t last = i + 1 < contexts ? in.direct(7) : kClasses - 1;
        if (last < symbol_class || last >= kClasses)
            return false;
        for (; symbol_class <= last; ++symbol_class)
            m_table_of[symbol_class] = &m_tables[i];
        const std::uint32_t used = in.direct(7);
        if (used < 1 || used > kTokens)
            return false;
        SymbolTable& table = m_tables[i];
        table.range.fill({ 0, 0 });
        std::uint32_t before = 0, sum = 0;
        for (std::uint32_t t = 0; t < used; ++t) {
            // The last frequency is not stored: it is what is left of the sum.
            const std::uint32_t f = t + 1 < used ? model[bit_length(before)].read(in) : kProbabilities - sum;
            if (f > kProbabilities - sum || in.overrun())
                return false;
            table.range[t] = { std::uint16_t(f), std::uint16_t(sum) };
            for (std::uint32_t slot = sum; slot < sum + f; ++slot)
                table.token[slot] = std::uint8_t(t);
            sum += f;
            before = f;
        }
    }
    return !in.overrun();
}

bool SymbolReader::finished() const
{
    const SymbolCursor& c = m_cursor;
    return c.word == c.word_count && c.state[0] == kStateLow && c.state[1] == kStateLow && c.bit <= c.raw_size * 8
        && c.raw_size * 8 - c.bit < 8;
}

}  // namespace PIMG_ABI
}  // namespace pimg
