// SPDX-License-Identifier: BSD-3-Clause
// Runs a fuzz target over files, without libFuzzer, and holds it to a budget of time and memory in proportion to each
// file, or over mutations of them for some seconds. Usage: fuzz_<target>_replay [--seconds N] FILE|FOLDER...
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <dirent.h>
#include <sys/resource.h>

#include "blind.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer)
#define PIMG_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(PIMG_SANITIZED)
constexpr double kSlow = 20.0;  // instrumented code is slower and keeps freed memory
#else
constexpr double kSlow = 1.0;
#endif

struct Spent {
    double seconds;    ///< of the processor: the machine may be busy
    double megabytes;  ///< the most there ever were
};

Spent spent()
{
    rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return { seconds(usage.ru_utime) + seconds(usage.ru_stime), double(usage.ru_maxrss) / 1024.0 };
}

// Files are read with the C library's functions, which MemorySanitizer knows.

std::vector<std::uint8_t> bytes_of(const std::string& path)
{
    std::vector<std::uint8_t> bytes;
    std::FILE* const in = std::fopen(path.c_str(), "rb");
    if (!in) {
        std::fprintf(stderr, "%s: cannot be read; expected a file or a folder of inputs\n", path.c_str());
        std::exit(2);
    }
    std::uint8_t some[4096];
    while (const std::size_t n = std::fread(some, 1, sizeof some, in))
        bytes.insert(bytes.end(), some, some + n);
    std::fclose(in);
    return bytes;
}

/// All files that are named, and those in the folders that are.
std::vector<std::string> files_of(int count, char** names)
{
    std::vector<std::string> files;
    for (int i = 0; i < count; ++i) {
        DIR* const folder = opendir(names[i]);
        if (!folder) {
            files.emplace_back(names[i]);
            continue;
        }
        while (const dirent* const entry = readdir(folder))
            if (entry->d_name[0] != '.')
                files.push_back(std::string(names[i]) + "/" + entry->d_name);
        closedir(folder);
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool replay(const std::string& path)
{
    const std::vector<std::uint8_t> bytes = bytes_of(path);
    const Spent before = spent();
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    const Spent after = spent();
    // A kilobyte takes at most 64 MB and 1 s; more bytes may take 1000 times their size and 0.01 s per kilobyte.
    const double kilobytes = double(bytes.size()) / 1024.0;
    const double seconds = after.seconds - before.seconds, megabytes = after.megabytes - before.megabytes;
    const bool fine = seconds <= kSlow * (1.0 + 0.01 * kilobytes) && megabytes <= kSlow * (64.0 + kilobytes);
    std::printf("%-40s %8zu bytes %7.3f s %+8.1f MB%s\n", path.c_str() + path.rfind('/') + 1, bytes.size(), seconds,
                megabytes, fine ? "" : "  TOO MUCH");
    return fine;
}

}  // namespace

int main(int argc, char** argv)
{
    const bool is_timed = argc > 1 && std::string(argv[1]) == "--seconds";
    const int seconds = is_timed && argc > 2 ? std::atoi(argv[2]) : 0;
    if (is_timed && seconds <= 0) {
        std::fprintf(stderr, "--seconds: expected a whole number above 0\n");
        return 2;
    }
    const int first = is_timed ? 3 : 1;
    const std::vector<std::string> files = files_of(argc - first, argv + first);
    if (files.empty()) {
        std::fprintf(stderr, "no files to replay\n");
        return 1;
    }
    if (is_timed) {
        std::vector<std::vector<std::uint8_t>> inputs;
        inputs.reserve(files.size());
        for (const std::string& file : files)
            inputs.push_back(bytes_of(file));
        std::printf("%zu executions\n", mutate_blindly(inputs, seconds));
        return 0;
    }
    bool fine = true;
    for (const std::string& file : files)
        fine &= replay(file);
    return fine ? 0 : 1;
}
