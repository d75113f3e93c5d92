// SPDX-License-Identifier: BSD-3-Clause
// What is worth keeping from one render to the next: hierarchies of frames, and whole results where a host asks for
// tiles. One cache serves all instances of all effects.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace pimg_ofx {

/// Something kept.
class Kept {
public:
    virtual ~Kept() = default;
    virtual std::size_t memory() const = 0;  ///< bytes now; it may have grown since it was put in
};

/// Thread-safe. What was asked for longest ago goes first when there is more than the limit; the newest stays whatever
/// its size. Things in use live on until their last user lets go of them.
class Cache {
public:
    /// Null, with a line in `error`, if it cannot be made; with an empty line if that was aborted.
    using Make = std::function<std::shared_ptr<const Kept>(std::string& error)>;
    using Aborted = std::function<bool()>;

    explicit Cache(std::size_t limit) : m_limit(limit) { }

    /// What is kept under `key`, else what make() makes, on this thread and without a lock. Other threads that ask for
    /// the same meanwhile wait for it, or give up when their aborted() says so.
    std::shared_ptr<const Kept> get(const std::string& key, const Make& make, const Aborted& aborted,
                                    std::string& error);

    /// Looks again how large the thing under `key` is, and makes room if necessary.
    void measure(const std::string& key);

    void clear();  ///< what is being made is kept when it is done
    std::size_t memory() const;
    std::size_t limit() const { return m_limit; }

private:
    struct Slot {
        std::shared_ptr<const Kept> thing;  ///< null while it is made
        std::size_t bytes = 0;
        std::uint64_t used = 0;  ///< number of the request
    };

    void make_room();

    mutable std::mutex m_mutex;
    std::condition_variable m_changed;
    std::map<std::string, Slot> m_slots;
    std::uint64_t m_requests = 0;
    const std::size_t m_limit;
};

/// The one cache. The environment variable PIMG_OFX_CACHE_MB, a whole number, sets its limit in units of 2^20 bytes; 2048
/// without it.
Cache& shared_cache();

}  // namespace pimg_ofx
