// SPDX-License-Identifier: BSD-3-Clause
// The few types every other header uses: indices, lattice points, status, parallel loops, progress.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The number of a vertex, a split or a pixel. Pictures have at most 2^31 pixels, so 32 bits are enough.
using Index = std::uint32_t;

/// The ghost vertex. It stands for everything outside the picture, and is a neighbour of every border vertex. It has
/// neither a position nor an intensity.
constexpr Index kGhost = 0xffffffffu;

/// Lattice units per pixel: all vertices lie on a lattice of 1/64 pixel, already while the mesh is being simplified. So
/// tests of orientation are exact, and a file stores exactly the mesh that the engine used.
constexpr std::int32_t kSubpixels = 64;

/// A position in lattice units. The centre of pixel (x, y) is at (64 x, 64 y), and y points down.
struct Point {
    std::int32_t x = 0, y = 0;
    friend bool operator==(Point a, Point b) { return a.x == b.x && a.y == b.y; }
    friend bool operator!=(Point a, Point b) { return !(a == b); }
};

/// Twice the signed area of triangle (a, b, c) in square lattice units, exact for positions inside a picture. It is
/// above 0 for every triangle of a valid mesh: on the screen, where y points down, such a triangle runs clockwise.
inline std::int64_t doubled_area(Point a, Point b, Point c)
{
    return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(c.x - a.x) * (b.y - a.y);
}

/// The outcome of an operation that can fail: success, or an error of one line that says what was wrong and, where it
/// helps, what was expected. The engine prints nothing, and throws nothing of its own; only std::bad_alloc may come from
/// it when memory runs out, and exceptions of functions that the caller passes in.
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

/// A loop that the caller implements with his own threads, since the engine has none. It must call body(i) once for
/// every i in [0, n), in any order and possibly several at the same time, and return when all calls are done. An empty
/// function stands for a plain loop. Results do not depend on the implementation. It needs no care about exceptions: no
/// body that is passed to it throws. The engine catches them inside the body, begins no further work, and throws the
/// first one again when the loop has returned, on the thread that started it.
using ParallelFor = std::function<void(std::size_t n, const std::function<void(std::size_t)>& body)>;

/// Called now and then with the share of the work that is done, 0..1. When it returns false, the work stops, and the
/// function that does it fails. It is always called on the thread that started the work.
using Progress = std::function<bool(float done)>;

}  // namespace PIMG_ABI
}  // namespace pimg
