// SPDX-License-Identifier: BSD-3-Clause
// An input of a fuzz target taken apart into numbers and texts. Past its end everything is 0 or empty.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

class Taken {
public:
    Taken(const std::uint8_t* data, std::size_t size) : m_data(data), m_left(size) { }

    /// The next bytes as a number of any plain type, in the machine's byte order.
    template<class T>
    T number()
    {
        T value {};
        const std::size_t n = std::min(sizeof value, m_left);
        std::memcpy(&value, m_data, n);
        skip(n);
        return value;
    }
    /// The text up to the next `end` or the end of the input; `end` is passed over.
    std::string text(char end)
    {
        const auto* stop = static_cast<const std::uint8_t*>(m_left ? std::memchr(m_data, end, m_left) : nullptr);
        const std::size_t n = stop ? std::size_t(stop - m_data) : m_left;
        std::string result(reinterpret_cast<const char*>(m_data), n);
        skip(stop ? n + 1 : n);
        return result;
    }
    const std::uint8_t* here() const { return m_data; }
    std::size_t left() const { return m_left; }

private:
    void skip(std::size_t n) { m_data += n, m_left -= n; }

    const std::uint8_t* m_data;
    std::size_t m_left;
};

/// A property that does not hold is a finding like any crash.
inline void must(bool holds)
{
    if (!holds)
        std::abort();
}

/// What every message is: one line, not empty, of a length that can be read.
inline void must_be_message(const std::string& error)
{
    must(!error.empty() && error.size() <= 2000 && error.find('\n') == error.npos);
}
