// SPDX-License-Identifier: BSD-3-Clause
// The action that makes pixels, and the hierarchies it makes them with.
#pragma once

#include <memory>
#include <string>

#include <pimg/progressive_image.h>

#include "cache.h"
#include "host/image.h"
#include "instance.h"
#include "watch.h"

namespace pimg_ofx {

/// The hierarchy of a frame.
class KeptHierarchy : public Kept {
public:
    std::size_t memory() const override { return image.memory(); }
    pimg::ProgressiveImage image;
};

/// Who wants to see a frame.
struct Viewer {
    Instance& instance;
    Watch& watch;
    OfxTime time;
};

/// The hierarchy of the source `image`, from the cache or built now with the instance's parameters; `key` is where it is in
/// the cache. Null with a line in `error`, which says nothing if the host wants to stop. May throw pimg::Stopped then.
std::shared_ptr<const KeptHierarchy> hierarchy_of(const Viewer& viewer, const Image& image, std::string& key,
                                                  std::string& error);

OfxStatus render(Instance& instance, const Properties& in);

}  // namespace pimg_ofx
