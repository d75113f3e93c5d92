// SPDX-License-Identifier: BSD-3-Clause
// Runs the benchmarks; bench/report.py makes the table of ratios of what they print as JSON.
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
