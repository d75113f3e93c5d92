// SPDX-License-Identifier: BSD-3-Clause
// A program whose libraries are loaded once for many runs: OpenImageIO brings three hundred, which take a third of a second,
// often more than the run. What is compiled with main() called warm_main() runs in a child for each request, which is as
// it would be if it had just been started. See warm.py.
// Arguments: shared libraries that are loaded now, too.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

int warm_main(int argc, char** argv);

namespace {

bool read_all(void* to, std::size_t size)
{
    for (char* at = static_cast<char*>(to); size > 0;) {
        const ssize_t count = read(STDIN_FILENO, at, size);
        if (count <= 0)
            return false;
        at += count;
        size -= std::size_t(count);
    }
    return true;
}

/// Length, then strings that each end in a zero: folder, files for standard output and error, arguments.
bool read_request(std::vector<std::string>& words)
{
    std::uint32_t size = 0;
    if (!read_all(&size, sizeof size))
        return false;
    std::string text(size, '\0');
    if (!read_all(text.data(), size))
        return false;
    words.clear();
    for (std::size_t at = 0; at < text.size(); at += words.back().size() + 1)
        words.emplace_back(text.c_str() + at);
    return words.size() > 3;
}

void redirect(const char* name, int flags, int to)
{
    const int file = open(name, flags, 0600);
    if (file < 0 || dup2(file, to) < 0)
        _exit(126);
    close(file);
}

[[noreturn]] void run(std::vector<std::string>& words)
{
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect(words[1].c_str(), O_WRONLY | O_TRUNC, STDOUT_FILENO);
    redirect(words[2].c_str(), O_WRONLY | O_TRUNC, STDERR_FILENO);
    if (chdir(words[0].c_str()) != 0)
        _exit(126);
    std::vector<char*> arguments;
    for (std::size_t i = 3; i < words.size(); ++i)
        arguments.push_back(words[i].data());
    arguments.push_back(nullptr);
    const int status = warm_main(int(arguments.size()) - 1, arguments.data());
    std::fflush(nullptr);
    _exit(status);  // what ends libraries would wait for threads that they began before the fork, which are not here
}

}  // namespace

int main(int argc, char** argv)
{
    for (int i = 1; i < argc; ++i)
        if (dlopen(argv[i], RTLD_NOW | RTLD_LOCAL) == nullptr) {
            std::fprintf(stderr, "%s\n", dlerror());
            return 1;
        }
    std::vector<std::string> words;
    while (read_request(words)) {
        const pid_t child = fork();
        if (child == 0)
            run(words);
        int state = 0;
        if (child < 0 || waitpid(child, &state, 0) != child)
            return 1;
        const std::int32_t answer = WIFSIGNALED(state) ? -WTERMSIG(state) : WEXITSTATUS(state);
        if (write(STDOUT_FILENO, &answer, sizeof answer) != sizeof answer)
            return 1;
    }
    return 0;
}
