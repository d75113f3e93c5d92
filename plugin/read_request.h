// SPDX-License-Identifier: BSD-3-Clause
// What is asked of a file as it is read: `name.pimg?key=value&key=value`, or the same keys as hints `pimg:key` of the
// configuration given to open().
#pragma once

#include <map>
#include <string>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <pimg/filter_table.h>

namespace pimg {
namespace io {

/// Keys that go with any filter or none.
struct ReadOptions {
    bool mip = false;
    bool partial = false;
    bool display = false;
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
    bool start(const Filter& filter, const std::string& value, std::string& error);
    bool set(const std::string& key, const std::string& value, bool& known, std::string& error);
    bool bind(std::string& error);
    const char* only_channel() const;

    const Filter* m_filter = nullptr;  ///< row of the registry
    OptionTexts m_texts;               ///< options given for it
    BoundFilter m_bound;
};

}  // namespace io

template<>
const std::vector<Option<io::ReadOptions>>& option_table<io::ReadOptions>();

}  // namespace pimg
