// SPDX-License-Identifier: BSD-3-Clause
// The few words every other header uses: indices, lattice points, status, parallel loops.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pimg {

/// Number of a vertex, split or pixel. 32 bits: pictures of up to 2^31 pixels.
using Index = std::uint32_t;

/// The ghost vertex that closes the fan of every border vertex: it stands for
/// everything outside the picture and has neither position nor intensity.
constexpr Index kGhost = 0xffffffffu;

/// Lattice units per pixel. Vertices sit on this lattice while the mesh is
/// being simplified, not only when it is stored, so that orientation tests are
/// exact and a file holds the very mesh the engine used.
constexpr std::int32_t kSubpixels = 64;

/// Position in lattice units; the centre of pixel (x, y) is (64 x, 64 y), y down.
struct Point {
    std::int32_t x = 0, y = 0;
    friend bool operator==(Point a, Point b) { return a.x == b.x && a.y == b.y; }
    friend bool operator!=(Point a, Point b) { return !(a == b); }
};

/// Twice the area of triangle (a, b, c) in lattice units, exact; positive for
/// the orientation every triangle of a valid mesh has.
inline std::int64_t doubled_area(Point a, Point b, Point c)
{
    return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(c.x - a.x) * (b.y - a.y);
}

/// Outcome of an operation that can fail: empty = fine, otherwise one line that
/// names what was wrong and what was expected. Core neither throws nor prints.
class Status {
public:
    Status() = default;
    static Status failure(std::string message)
    {
        Status s;
        s.m_error = std::move(message);
        return s;
    }
    bool ok() const { return m_error.empty(); }
    explicit operator bool() const { return ok(); }
    const std::string& error() const { return m_error; }

private:
    std::string m_error;
};

/// Runs body(i) for every i in [0, n), in any order, possibly at once, and
/// returns when all are done. Results never depend on which implementation is
/// given; an empty function means a plain loop. Core owns no threads: hosts
/// pass their pool. Bodies given to it never throw: when a piece of work throws,
/// no other is begun, and once those at work have ended the first exception is
/// thrown again on the thread that started the loop.
using ParallelFor = std::function<void(std::size_t n, const std::function<void(std::size_t)>& body)>;

/// Called now and then with the share of the work done, 0..1; returning false
/// asks for a clean stop. Always called from the thread that started the work.
using Progress = std::function<bool(float done)>;

}  // namespace pimg
