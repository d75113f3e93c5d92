// SPDX-License-Identifier: BSD-3-Clause
// Every instruction set this machine has, one after the other.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace pimg::test {

/// Calls body(number, name) with each chosen in turn, numbered from 0.
template<class Body>
void on_every_target(Body&& body)
{
    const auto all = hwy::SupportedTargets();
    int tried = 0;
    for (int bit = 0; bit < 63; ++bit) {
        const std::int64_t target = std::int64_t(1) << bit;
        if (!(all & target))
            continue;
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        body(tried++, hwy::TargetName(target));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GE(tried, 1);
    testing::Test::RecordProperty("targets", tried);
}

}  // namespace pimg::test
