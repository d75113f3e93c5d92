// SPDX-License-Identifier: BSD-3-Clause
// Fuzzing without instrumentation, for builds by any compiler: inputs are mutated without knowing what they reach.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// Gives the target random mutations of the inputs for so many seconds and returns how many there were. An input that
/// ends the process or takes 20 seconds is left in the working folder as `finding`. Its random numbers begin alike in
/// each run, and the process's time decides how many are drawn.
std::size_t mutate_blindly(const std::vector<std::vector<std::uint8_t>>& inputs, int seconds);
