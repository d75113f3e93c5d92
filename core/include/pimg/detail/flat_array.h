// SPDX-License-Identifier: BSD-3-Clause
// A large array of plain data that starts on a cache line. Unlike std::vector it leaves new elements uninitialised, so
// that the thread that fills them touches them first, and gives memory back in place, without a copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>

#include <pimg/abi.h>
#endif

namespace pimg {
inline namespace PIMG_ABI {

template<class T>
class FlatArray {
    static_assert(std::is_trivially_copyable_v<T>, "elements are moved as bytes");

public:
    FlatArray() = default;
    FlatArray(FlatArray&& other) noexcept { swap(other); }
    FlatArray& operator=(FlatArray&& other) noexcept
    {
        swap(other);
        return *this;
    }
    ~FlatArray()
    {
        give_back_pages_from(0);
        std::free(m_block);
    }

    std::size_t size() const { return m_size; }
    T* data() { return m_data; }
    const T* data() const { return m_data; }
    T& operator[](std::size_t i) { return m_data[i]; }
    const T& operator[](std::size_t i) const { return m_data[i]; }
    T* begin() { return m_data; }
    T* end() { return m_data + m_size; }
    const T* begin() const { return m_data; }
    const T* end() const { return m_data + m_size; }

    void reserve(std::size_t n)
    {
        if (n > m_capacity)
            reallocate(n);
    }

    /// Appends n elements without a value; returns the first.
    T* extend(std::size_t n)
    {
        if (m_size + n > m_capacity)
            reallocate(m_size + n > 2 * m_capacity ? m_size + n : 2 * m_capacity);
        m_size += n;
        return m_data + (m_size - n);
    }

    void push_back(const T& value) { *extend(1) = value; }

    /// Keeps the first n elements. The pages of the others go back to the system, also where the allocator would keep them
    /// for what is asked for next: that made the peak of building a third higher.
    void shrink(std::size_t n)
    {
        give_back_pages_from(n);
        m_size = n;
        reallocate(n);
    }

private:
    static constexpr std::size_t kLine = 64;

    void swap(FlatArray& other) noexcept
    {
        std::swap(m_block, other.m_block);
        std::swap(m_data, other.m_data);
        std::swap(m_size, other.m_size);
        std::swap(m_capacity, other.m_capacity);
    }

    void give_back_pages_from([[maybe_unused]] std::size_t n)
    {
#ifdef __linux__
        constexpr std::uintptr_t kPage = std::uintptr_t(1) << 16;  // a multiple of the page of every machine
        const auto place = [&](std::size_t i) {
            return reinterpret_cast<std::uintptr_t>(m_data + i);
        };
        const std::uintptr_t first = (place(n) + kPage - 1) / kPage * kPage, last = place(m_capacity) / kPage * kPage;
        if (m_data != nullptr && first < last)
            madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
#endif
    }

    void reallocate(std::size_t capacity)
    {
        const std::size_t offset =
            m_block ? std::size_t(reinterpret_cast<char*>(m_data) - static_cast<char*>(m_block)) : 0;
        void* const block = std::realloc(m_block, capacity * sizeof(T) + kLine);
        if (!block)
            throw std::bad_alloc();
        char* const from = static_cast<char*>(block);
        char* const to = from + (kLine - reinterpret_cast<std::uintptr_t>(block) % kLine) % kLine;
        if (m_size > 0 && to != from + offset)
            std::memmove(to, from + offset, m_size * sizeof(T));
        m_block = block;
        m_data = reinterpret_cast<T*>(to);
        m_capacity = capacity;
    }

    void* m_block = nullptr;
    T* m_data = nullptr;
    std::size_t m_size = 0, m_capacity = 0;
};

}  // namespace PIMG_ABI
}  // namespace pimg
