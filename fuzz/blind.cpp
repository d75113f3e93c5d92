// SPDX-License-Identifier: BSD-3-Clause
#include "blind.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <random>

#include <fcntl.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Of targets whose inputs have a framing that mutations keep; null for the others.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                                             unsigned int seed);

namespace {

constexpr std::size_t kMostBytes = 8192;
constexpr unsigned kHangs = 20;  ///< seconds

std::mt19937& random_bits()
{
    static std::mt19937 generator(1);
    return generator;
}

std::size_t below(std::size_t end)
{
    return random_bits()() % end;
}

/// What the target is given now, for the handler of signals.
const std::uint8_t* s_given = nullptr;
std::size_t s_size = 0;

/// Keeps the input and lets the signal do what it does without us.
void keep_finding(int signal)
{
    const int file = open("finding", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const bool kept = file >= 0 && write(file, s_given, s_size) == ssize_t(s_size);
    constexpr char kText[] = "the input is in the file `finding`\n";
    if (kept && write(STDERR_FILENO, kText, sizeof kText - 1) < 0)
        _exit(1);
    struct sigaction usual { };
    usual.sa_handler = SIG_DFL;
    sigaction(signal, &usual, nullptr);
    raise(signal);
}

void keep_findings()
{
    static std::uint8_t stack[1 << 16];  // the other one may be what overflowed
    stack_t other {};
    other.ss_sp = stack;
    other.ss_size = sizeof stack;
    sigaltstack(&other, nullptr);
    struct sigaction keep { };
    keep.sa_handler = keep_finding;
    keep.sa_flags = SA_ONSTACK;
    for (const int signal : { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM })
        sigaction(signal, &keep, nullptr);
}

}  // namespace

/// One small change, by the name libFuzzer gives to its own, which mutators of a framing call.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size)
{
    const std::size_t at = size == 0 ? 0 : below(size), run = 1 + below(8);
    switch (size == 0 ? 3 : below(6)) {
    case 0:
        data[at] = std::uint8_t(data[at] ^ (1u << below(8)));
        return size;
    case 1:
        data[at] = std::uint8_t(random_bits()());
        return size;
    case 2: {  // numbers at which arithmetic turns
        constexpr std::uint8_t kEdges[] = { 0x00, 0xff, 0x7f, 0x80 };
        std::fill(data + at, data + std::min(size, at + run), kEdges[below(4)]);
        return size;
    }
    case 3: {  // room for some, filled with what came before
        const std::size_t more = std::min(run, max_size - size);
        std::memmove(data + at + more, data + at, size - at);
        for (std::size_t i = at; i < at + more; ++i)
            data[i] = i >= run ? data[i - run] : std::uint8_t(random_bits()());
        return size + more;
    }
    case 4: {
        const std::size_t less = std::min(run, size - at);
        std::memmove(data + at, data + at + less, size - at - less);
        return size - less;
    }
    default: {  // the same bytes in another place
        const std::size_t to = below(size);
        std::memmove(data + to, data + at, std::min({ run, size - at, size - to }));
        return size;
    }
    }
}

std::size_t mutate_blindly(const std::vector<std::vector<std::uint8_t>>& inputs, int seconds)
{
    using Clock = std::chrono::steady_clock;
    keep_findings();
    const Clock::time_point end = Clock::now() + std::chrono::seconds(seconds);
    std::size_t count = 0;
    std::vector<std::uint8_t> given(kMostBytes);
    for (; Clock::now() < end; ++count) {
        const std::vector<std::uint8_t>& input = inputs[below(inputs.size())];
        std::size_t size = std::min(input.size(), kMostBytes);
        std::copy_n(input.begin(), size, given.begin());
        for (std::size_t changes = 1 + below(4); changes > 0; --changes)
            size = LLVMFuzzerCustomMutator != nullptr
                ? LLVMFuzzerCustomMutator(given.data(), size, kMostBytes, unsigned(random_bits()()))
                : LLVMFuzzerMutate(given.data(), size, kMostBytes);
        s_given = given.data();
        s_size = size;
        alarm(kHangs);
        // A copy of just that size, so that reading past its end is an error that tools for memory see.
        const std::vector<std::uint8_t> exact(given.begin(), given.begin() + std::ptrdiff_t(size));
        LLVMFuzzerTestOneInput(exact.data(), exact.size());
    }
    alarm(0);
    return count;
}
