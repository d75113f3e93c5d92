// SPDX-License-Identifier: BSD-3-Clause
// Runs the benchmarks and ends with the ratios the project promises, all from this run.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

namespace {

/// The usual table, remembering items per second of every benchmark.
class Reporter : public benchmark::ConsoleReporter {
public:
    Reporter() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_ColorTabular : OO_Tabular) { }

    void ReportRuns(const std::vector<Run>& runs) override
    {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) {
            const auto rate = run.counters.find("items_per_second");
            if (!run.error_occurred && run.run_type == Run::RT_Iteration && rate != run.counters.end())
                m_rates[run.run_name.function_name + "/" + run.run_name.args] = rate->second;
        }
    }

    /// Prints a / b, and what is promised, when both were measured.
    void ratio(const char* what, const char* a, const char* b, const char* promise) const
    {
        const auto i = m_rates.find(a), j = m_rates.find(b);
        if (i != m_rates.end() && j != m_rates.end())
            std::printf("%-62s %8.2f   (%s)\n", what, i->second / j->second, promise);
    }

    void rate(const char* what, const char* a, const char* promise) const
    {
        const auto i = m_rates.find(a);
        if (i != m_rates.end())
            std::printf("%-62s %8.2f   (%s)\n", what, i->second / 1e6, promise);
    }

private:
    std::map<std::string, double> m_rates;
};

}  // namespace

int main(int argc, char** argv)
{
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 1;
    Reporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);

    std::printf("\n");
    reporter.ratio("build over CGAL's Lindstrom-Turk, vertices/s", "build/512", "build_cgal/512", ">= 15");
    reporter.ratio("hdr_compress anew over building the image, pixels/s", "retune_hdr_compress/512", "build_image/512",
                   ">= 15");
    reporter.rate("sweep, million splits/s", "sweep/512", ">= 60");
    reporter.ratio("build, time per pixel at 4 Mpixel over 0.25 Mpixel", "build/512", "build/2048", "<= 1.5");
    benchmark::Shutdown();
    return 0;
}
