// SPDX-License-Identifier: BSD-3-Clause
// The values of a vertex in all channels as one number of a vector register. Written one by one and read together soon
// after, as in a sweep, they would have to wait for the memory.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

typedef float FourFloats __attribute__((vector_size(16)));

/// One channel, or up to four of which the last may be of no use.
template<int C>
using Lanes = std::conditional_t<C == 1, float, FourFloats>;

template<int C>
constexpr int kLanes = C == 1 ? 1 : 4;

/// `values` holds kLanes<C> floats for each place.
template<int C>
Lanes<C> lanes_at(const float* values, std::size_t place)
{
    Lanes<C> lanes;
    std::memcpy(&lanes, values + place * std::size_t(kLanes<C>), sizeof lanes);
    return lanes;
}

template<int C>
void set_lanes(Lanes<C> lanes, std::size_t place, float* values)
{
    std::memcpy(values + place * std::size_t(kLanes<C>), &lanes, sizeof lanes);
}

/// The number in every lane.
template<int C>
Lanes<C> in_all_lanes(float value)
{
    if constexpr (C == 1)
        return value;
    else
        return FourFloats { value, value, value, value };
}

/// number(c) in the lanes of the channels, 0 in the others.
template<int C, class Number>
Lanes<C> lanes_of(Number&& number)
{
    if constexpr (C == 1)
        return number(0);
    else
        return FourFloats { number(0), number(1), C > 2 ? number(C > 2 ? 2 : 0) : 0.0f,
                            C > 3 ? number(C > 3 ? 3 : 0) : 0.0f };
}

template<int C>
float lane(Lanes<C> lanes, int c)
{
    if constexpr (C == 1)
        return lanes;
    else
        return lanes[c];
}

/// interpolate() of hierarchy.h in every lane.
template<int C>
Lanes<C> interpolate_lanes(Lanes<C> s, Lanes<C> a, Lanes<C> b, float wa, float wb)
{
    return s + (in_all_lanes<C>(wa) * (a - s) + in_all_lanes<C>(wb) * (b - s));
}

}  // namespace PIMG_ABI
}  // namespace pimg
