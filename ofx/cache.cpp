// SPDX-License-Identifier: BSD-3-Clause
#include "cache.h"

#include <chrono>
#include <cstdlib>

namespace pimg_ofx {

namespace {

/// How often a waiting thread asks whether the host wants to stop. An abort is to take effect within 50 ms.
constexpr std::chrono::milliseconds kPatience(10);

/// In 2^20 bytes: about twenty hierarchies of pictures of one megapixel.
constexpr std::size_t kUsualLimit = 2048;

}  // namespace

std::shared_ptr<const Kept> Cache::get(const std::string& key, const Make& make, const Aborted& aborted,
                                       std::string& error)
{
    std::unique_lock<std::mutex> lock(m_mutex);
    for (auto slot = m_slots.find(key); slot != m_slots.end(); slot = m_slots.find(key)) {
        if (slot->second.thing != nullptr) {
            slot->second.used = ++m_requests;
            return slot->second.thing;
        }
        m_changed.wait_until(lock, std::chrono::system_clock::now() + kPatience);
        lock.unlock();
        if (aborted())
            return nullptr;
        lock.lock();
    }
    m_slots[key].used = ++m_requests;
    lock.unlock();
    std::shared_ptr<const Kept> thing;
    try {
        thing = make(error);
    } catch (...) {
        lock.lock();
        m_slots.erase(key);
        m_changed.notify_all();
        throw;
    }
    const std::size_t bytes = thing != nullptr ? thing->memory() : 0;
    lock.lock();
    if (thing == nullptr)
        m_slots.erase(key);
    else {
        Slot& slot = m_slots[key];
        slot.thing = thing;
        slot.bytes = bytes;
    }
    make_room();
    m_changed.notify_all();
    return thing;
}

void Cache::measure(const std::string& key)
{
    std::shared_ptr<const Kept> thing;
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        const auto slot = m_slots.find(key);
        if (slot == m_slots.end())
            return;
        thing = slot->second.thing;
    }
    const std::size_t bytes = thing != nullptr ? thing->memory() : 0;
    const std::lock_guard<std::mutex> lock(m_mutex);
    const auto slot = m_slots.find(key);
    if (slot == m_slots.end() || slot->second.thing != thing)
        return;
    slot->second.bytes = bytes;
    make_room();
}

void Cache::make_room()
{
    std::size_t total = 0;
    for (const auto& [key, slot] : m_slots)
        total += slot.bytes;
    while (total > m_limit) {
        auto oldest = m_slots.end();
        std::size_t kept = 0;
        for (auto slot = m_slots.begin(); slot != m_slots.end(); ++slot) {
            if (slot->second.thing == nullptr)
                continue;
            ++kept;
            if (oldest == m_slots.end() || slot->second.used < oldest->second.used)
                oldest = slot;
        }
        if (kept < 2)
            return;
        total -= oldest->second.bytes;
        m_slots.erase(oldest);
    }
}

void Cache::clear()
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    for (auto slot = m_slots.begin(); slot != m_slots.end();)
        slot = slot->second.thing != nullptr ? m_slots.erase(slot) : std::next(slot);
}

std::size_t Cache::memory() const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    std::size_t total = 0;
    for (const auto& [key, slot] : m_slots)
        total += slot.bytes;
    return total;
}

Cache& shared_cache()
{
    static Cache cache([] {
        const char* text = std::getenv("PIMG_OFX_CACHE_MB");
        char* end = nullptr;
        const unsigned long given = text != nullptr ? std::strtoul(text, &end, 10) : 0;
        const bool fine = text != nullptr && end != text && *end == '\0';
        return (fine ? std::size_t(given) : kUsualLimit) << 20;
    }());
    return cache;
}

}  // namespace pimg_ofx
