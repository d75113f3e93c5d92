// SPDX-License-Identifier: BSD-3-Clause
// What is asked of a file as it is read: `name.pimg?key=value&key=value`, or the same keys as hints `pimg:key` of the
// configuration given to open().
#pragma once

#include <map>
#include <memory>
#include <string>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <pimg/progressive_image.h>

namespace pimg {
namespace io {

/// Keys that go with any filter or none.
struct ReadOptions {
    bool mip = false;
    bool partial = false;
    bool display = false;
};

/// A filter that can be asked for, with its options; see the table in read_request.cpp.
class ReadFilter {
public:
    virtual ~ReadFilter() = default;
    /// Sets one option; `known` tells keys that are not among them from bad values.
    virtual bool set(const std::string& key, const std::string& value, bool& known, std::string& error) = 0;
    /// Takes the value given to the filter's own key. False: the filter is not wanted.
    virtual bool start(const std::string& value, std::string& error) = 0;
    /// Whether the options go together, as far as can be told without the picture.
    virtual bool check(std::string& error) const = 0;
    virtual bool run(OIIO::ImageBuf& dst, const ProgressiveImage& src, int nthreads) const = 0;
    virtual std::string keys() const = 0;
    /// The name of the result's only channel; "": the channels are those of the file.
    virtual std::string mask() const = 0;
    bool floating = false;  ///< results may leave the range of the file's samples
    bool light = false;     ///< results are linear light, whatever the file's samples are
};

struct ReadRequest : ReadOptions {
    BuildOptions build;
    bool rebuild = false;  ///< the hierarchy is to be one of these options, whatever the file has

    /// Keys of the query win over hints. In the query a key that is not known is an error; a hint may be meant for
    /// other formats.
    bool parse(const std::string& name, const OIIO::ImageSpec& config, std::string& error);

    bool filtered() const { return m_filter != nullptr; }

    /// Makes the header of the stored picture that of the result.
    bool change_spec(OIIO::ImageSpec& spec, std::string& error) const;

    bool run(OIIO::ImageBuf& dst, const ProgressiveImage& src, int nthreads) const;

private:
    struct Given {
        std::string value;
        bool in_query;
    };
    using Keys = std::map<std::string, Given>;

    bool choose_filter(Keys& keys, std::string& error);
    bool set(const std::string& key, const std::string& value, bool& known, std::string& error);

    std::shared_ptr<ReadFilter> m_filter;
};

}  // namespace io

template<>
const std::vector<Option<io::ReadOptions>>& option_table<io::ReadOptions>();

}  // namespace pimg
