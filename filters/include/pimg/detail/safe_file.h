// SPDX-License-Identifier: BSD-3-Clause
// Files that appear under their names whole or not at all, for everything this project writes.
#pragma once

#include <cstddef>
#include <string>

#include <OpenImageIO/filesystem.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A file that takes the place of its target when it is complete. It is made beside the target, under another name, with
/// the target's permissions; a link stays a link, and what it leads to is replaced. A target that is a pipe or a device
/// is written to directly. Without keep() nothing stays and the target is as it was.
class PIMG_EXPORT_DETAIL SafeFile {
public:
    SafeFile() = default;
    ~SafeFile();
    SafeFile(const SafeFile&) = delete;
    SafeFile& operator=(const SafeFile&) = delete;

    /// Creates it, as `temporary` if that is given, which must lie in the folder of final_name(target). This and the
    /// following return false with error() set.
    bool open(const std::string& target, const std::string& temporary = "");
    bool write(const void* data, std::size_t size);
    /// Whether there was still room behind the end: some writers do not notice that there was none.
    bool has_room();
    /// Whether it has no bytes: some formats write to a screen, or nothing at all.
    bool is_empty() const;
    /// On disk, under its name.
    bool keep();

    /// Where the bytes go until then; the target itself if that is a pipe or a device.
    const std::string& name() const { return m_name; }
    int descriptor() const { return m_fd; }
    /// What went wrong first, in the system's words.
    const std::string& error() const { return m_error; }
    bool fail(int code);

    /// The file that a chain of links leads to, or the name itself.
    static std::string final_name(const std::string& target);
    /// A name that no file has, in the folder of final_name(target) and with its extension.
    static std::string temporary_name(const std::string& target);

private:
    std::string m_target, m_name, m_error;
    bool m_beside = false;  ///< a file of its own that replaces the target
    int m_fd = -1;
};

/// Writes all of a file or nothing; false with an error in the system's words.
PIMG_EXPORT_DETAIL bool write_whole_file(const std::string& target, const std::string& bytes, std::string& error);

/// A SafeFile for writers of OpenImageIO. Many of them do not look at what write() returns: error() of the file knows.
class PIMG_EXPORT_DETAIL SafeFileProxy final : public OIIO::Filesystem::IOProxy {
public:
    explicit SafeFileProxy(SafeFile& file) : IOProxy(file.name(), Write), m_file(file) { }
    ~SafeFileProxy() override { flush_buffer(); }
    const char* proxytype() const override { return "safe_file"; }
    void close() override { flush_buffer(); }
    bool seek(std::int64_t offset) override;
    std::size_t read(void* to, std::size_t size) override;
    std::size_t write(const void* from, std::size_t size) override;
    std::size_t pread(void* to, std::size_t size, std::int64_t offset) override;
    std::size_t pwrite(const void* from, std::size_t size, std::int64_t offset) override;
    std::size_t size() const override;
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
    void flush() override
    {
        flush_buffer();
    }
#else
    void flush() const override
    {
        flush_buffer();
    }
#endif

private:
    bool flush_buffer() const;

    SafeFile& m_file;
    mutable std::string m_buffer;  ///< bytes before m_pos that the file has not got yet
};

}  // namespace PIMG_ABI
}  // namespace pimg
