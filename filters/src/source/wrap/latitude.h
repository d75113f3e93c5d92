// SPDX-License-Identifier: BSD-3-Clause
// How much the rows of a panorama count: a pixel near a pole shows little of the sphere.
#pragma once

#include <vector>

#include <pimg/channels.h>

#include "source/wrap/wrap.h"

namespace pimg {
inline namespace PIMG_ABI {

/// The cosine of the latitude of each row of the padded picture, above 0. The picture shows 360 degrees from left to right
/// and as many to a pixel from top to bottom, but at most 180 in all, with the horizon in the middle.
std::vector<float> latitude_weights(const Wrap& wrap);

/// The channels of a guide with what differs from their mean multiplied by the weights of its row: the volume between two
/// meshes, the cost of simplification, is then multiplied by it, as if pixels had the area that they have on the sphere.
std::vector<Raster> weighted_by_latitude(const std::vector<Raster>& channels, const Wrap& wrap);

}  // namespace PIMG_ABI
}  // namespace pimg
