// SPDX-License-Identifier: BSD-3-Clause
// Which colour space the samples of a clip are in: what the user chose, else what the host's colour management says.
#pragma once

#include <string>

#include "instance.h"

namespace pimg_ofx {

/// The OpenColorIO configuration of a host that works with one, for a pimg::ColourConfigScope; "" if it does not, or if it
/// cannot be read.
std::string host_config(const Instance& instance);

/// A name for the option incolorspace; "" for what pimg takes pixels of that depth as: scene-linear for floats, sRGB for
/// whole numbers. False, with a line in `error`, if the user chose a name that is unknown.
bool source_space(const Instance& instance, OfxTime time, const OIIO::TypeDesc& depth, std::string& space,
                  std::string& error);

/// pimg's name for a space of OpenFX's own configuration, in which its basic spaces stand for "".
std::string space_of_host(const std::string& name);

/// Asks for scene-linear input where the host manages colours and the user has not chosen anything.
bool prefer_spaces(const Instance& instance, OfxTime time, const Properties& out);

/// Answers kOfxImageEffectActionGetOutputColourspace.
OfxStatus output_space(const Instance& instance, OfxTime time, const Properties& out);

}  // namespace pimg_ofx
