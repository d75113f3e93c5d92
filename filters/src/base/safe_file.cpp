// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/safe_file.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace Filesystem = OIIO::Filesystem;

SafeFile::~SafeFile()
{
    if (m_fd >= 0)
        ::close(m_fd);
    if (m_beside)
        ::unlink(m_name.c_str());
}

bool SafeFile::fail(int code)
{
    if (m_error.empty())
        m_error = std::strerror(code);
    return false;
}

std::string SafeFile::final_name(const std::string& target)
{
    const std::unique_ptr<char, decltype(&std::free)> path(::realpath(target.c_str(), nullptr), &std::free);
    return path ? path.get() : target;
}

std::string SafeFile::temporary_name(const std::string& target)
{
    const std::string name = final_name(target);
    return Filesystem::unique_path(Filesystem::replace_extension(name, ".%%%%%%%%.temp" + Filesystem::extension(name)));
}

bool SafeFile::open(const std::string& target, const std::string& temporary)
{
    struct stat there = {};
    const bool exists = ::stat(target.c_str(), &there) == 0;
    m_target = final_name(target);
    if (exists && S_ISDIR(there.st_mode))
        return fail(EISDIR);
    if (exists && ::access(m_target.c_str(), W_OK) != 0)
        return fail(errno);
    if (exists && !S_ISREG(there.st_mode)) {
        m_name = m_target;
        m_fd = ::open(m_target.c_str(), O_WRONLY | O_CLOEXEC);
        return m_fd >= 0 || fail(errno);
    }
    m_name = temporary.empty() ? temporary_name(target) : temporary;
    m_fd = ::open(m_name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (m_fd < 0)
        return fail(errno);
    m_beside = true;
    if (exists)
        (void)!::fchmod(m_fd, there.st_mode & 07777);
    return true;
}

bool SafeFile::write(const void* data, std::size_t size)
{
    for (const char* bytes = static_cast<const char*>(data); size > 0;) {
        const ssize_t n = ::write(m_fd, bytes, std::min(size, std::size_t(1) << 30));
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return fail(n < 0 ? errno : ENOSPC);
        bytes += n;
        size -= std::size_t(n);
    }
    return m_error.empty();
}

bool SafeFile::is_empty() const
{
    struct stat now = {};
    return m_beside && ::fstat(m_fd, &now) == 0 && now.st_size == 0;
}

bool SafeFile::has_room()
{
    struct stat now = {};
    if (!m_beside)
        return true;
    if (::fstat(m_fd, &now) != 0)
        return fail(errno);
    // A write that a full disk has cut off leaves less than one block free.
    constexpr off_t kRoom = 1 << 12;
    const int code = ::posix_fallocate(m_fd, now.st_size, kRoom);
    if (::ftruncate(m_fd, now.st_size) != 0)
        return fail(errno);
    return code == 0 || fail(code);
}

bool SafeFile::keep()
{
    if (!m_error.empty())
        return false;
    if (m_beside && ::fsync(m_fd) != 0)
        return fail(errno);
    if (::close(std::exchange(m_fd, -1)) != 0)
        return fail(errno);
    if (m_beside && ::rename(m_name.c_str(), m_target.c_str()) != 0)
        return fail(errno);
    m_beside = false;
    return true;
}

bool write_whole_file(const std::string& target, const std::string& bytes, std::string& error)
{
    SafeFile file;
    if (file.open(target) && file.write(bytes.data(), bytes.size()) && file.keep())
        return true;
    error = file.error();
    return false;
}

// ---- for OpenImageIO's writers ----------------------------------------------------------------------------------

bool SafeFileProxy::flush_buffer() const
{
    const std::string bytes = std::move(m_buffer);
    m_buffer.clear();
    return m_file.write(bytes.data(), bytes.size());
}

bool SafeFileProxy::seek(std::int64_t offset)
{
    if (offset == m_pos)
        return true;
    if (!flush_buffer())
        return false;
    if (::lseek(m_file.descriptor(), offset, SEEK_SET) < 0)
        return m_file.fail(errno);
    m_pos = offset;
    return true;
}

std::size_t SafeFileProxy::write(const void* from, std::size_t size)
{
    constexpr std::size_t kBuffer = 1 << 16;
    m_buffer.append(static_cast<const char*>(from), size);
    m_pos += std::int64_t(size);
    return m_buffer.size() < kBuffer || flush_buffer() ? size : 0;
}

std::size_t SafeFileProxy::read(void* to, std::size_t size)
{
    const std::size_t count = pread(to, size, m_pos);
    return seek(m_pos + std::int64_t(count)) ? count : 0;
}

std::size_t SafeFileProxy::pread(void* to, std::size_t size, std::int64_t offset)
{
    if (!flush_buffer())
        return 0;
    const ssize_t count = ::pread(m_file.descriptor(), to, size, offset);
    return count < 0 ? 0 : std::size_t(count);
}

std::size_t SafeFileProxy::pwrite(const void* from, std::size_t size, std::int64_t offset)
{
    const std::int64_t back = m_pos;
    const bool written = seek(offset) && m_file.write(from, size);
    m_pos = offset + std::int64_t(size);
    return written && seek(back) ? size : 0;
}

std::size_t SafeFileProxy::size() const
{
    struct stat now = {};
    return flush_buffer() && ::fstat(m_file.descriptor(), &now) == 0 ? std::size_t(now.st_size) : 0;
}

}  // namespace PIMG_ABI
}  // namespace pimg
