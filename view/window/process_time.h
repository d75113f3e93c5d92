// SPDX-License-Identifier: BSD-3-Clause
// When this program was started.
#pragma once

namespace pimgview {

/// Seconds since the system started this process, in steps of a hundredth: what loading libraries took is in it. 0 where
/// the system does not tell, as Linux does in /proc.
double seconds_since_start();

}  // namespace pimgview
