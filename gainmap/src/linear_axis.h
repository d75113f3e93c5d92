// SPDX-License-Identifier: BSD-3-Clause
// One axis of a small picture that is interpolated linearly to a large one, pixel centres at halves, as graphics hardware
// does; and the way back in least squares.
#pragma once

#include <cstddef>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

class LinearAxis {
public:
    /// Where a pixel of the large picture lies: value = (1 - share) * small[first] + share * small[second].
    struct Place {
        int first, second;
        double share;
    };

    /// `fine` pixels, and one of the small picture for every `scale` of them, the last one for what is left.
    LinearAxis(int fine, int scale) : LinearAxis(between(fine, (fine + scale - 1) / scale)) { }
    static LinearAxis between(int fine, int coarse);

    int fine() const { return int(m_places.size()); }
    int coarse() const { return int(m_diagonal.size()); }
    Place place(int pixel) const { return m_places[std::size_t(pixel)]; }

    /// The `coarse()` values that come closest to `fine()` given ones once they are interpolated, in the least squares;
    /// kept within the range of the given values around each, so that nothing rings beside an edge.
    void fit(const double* values, std::size_t stride, double* result, std::size_t result_stride) const;

private:
    LinearAxis() = default;

    std::vector<Place> m_places;
    // The normal equations, which are tridiagonal, eliminated: pivots, and what is above the diagonal over the pivot.
    std::vector<double> m_diagonal, m_above, m_ratio;
};

}  // namespace PIMG_ABI
}  // namespace pimg
