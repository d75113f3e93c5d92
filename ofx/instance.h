// SPDX-License-Identifier: BSD-3-Clause
// One effect in somebody's project: its clips, and its parameters read as options.
#pragma once

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include <pimg/filter_table.h>

#include "effect.h"
#include "host/host.h"
#include "host/image.h"

namespace pimg_ofx {

class Instance {
public:
    Instance(const Host& host, const Effect& effect, OfxImageEffectHandle handle);

    const Host& host() const { return m_host; }
    const Effect& effect() const { return m_effect; }
    OfxImageEffectHandle handle() const { return m_handle; }
    OfxImageClipHandle source_clip() const { return m_source; }
    OfxImageClipHandle output_clip() const { return m_output; }
    Properties of_clip(OfxImageClipHandle clip) const;

    /// The region of definition of the source at `time`, in canonical coordinates, or what the project's window holds of a
    /// region without an end. False if there is no source.
    bool source_region(OfxTime time, OfxRectD& region) const;

    /// The options of the owner that are given, at `time`. Lengths in pixels are multiplied by `scale`.
    pimg::OptionTexts options(Owner owner, OfxTime time, double scale = 1.0) const;

    /// One option of those, or "" if it is not given.
    std::string option(const std::string& key, OfxTime time) const;

    double real(const std::string& name, OfxTime time) const;
    int number(const std::string& name, OfxTime time) const;
    std::string text(const std::string& name, OfxTime time) const;
    /// Null if there is no such parameter.
    OfxParamHandle parameter(const std::string& name) const;

    /// True for the first who asks until end_of_progress(): hosts show one bar for an instance.
    bool may_show_progress() { return !m_in_progress.exchange(true); }
    void end_of_progress() { m_in_progress = false; }

    /// A message that stays until the next time that all is well.
    void complain(const std::string& text);
    void be_content();

private:
    std::string text_of(const Parameter& parameter, OfxTime time, double scale) const;
    std::string number_text(const Parameter& parameter, OfxTime time, double scale) const;

    const Host& m_host;
    const Effect& m_effect;
    const OfxImageEffectHandle m_handle;
    OfxImageClipHandle m_source = nullptr, m_output = nullptr;
    std::map<std::string, OfxParamHandle> m_parameters;
    std::atomic<bool> m_in_progress { false }, m_complained { false };
};

/// The instance behind a handle; null if it is none of ours.
Instance* instance_of(const Host& host, OfxImageEffectHandle handle);

}  // namespace pimg_ofx
