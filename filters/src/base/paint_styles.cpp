// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/option_text.h>
#include <pimg/options.h>

#include <cassert>

namespace pimg {
inline namespace PIMG_ABI {

const std::vector<Preset>& paint_styles()
{
    // All chosen by eye, on photographs of half a megapixel to two.
    static const std::vector<Preset> styles = {
        { "oil",
          "min=0.0035:max=0.04:brush=bristle:length=1:tolerance=4:cover=1:opacity=1:impasto=0.4:jitter_colour=0.08:"
          "jitter_angle=0.15:jitter_size=0.2:canvas=source",
          "long strokes of a bristle brush, fine where features are" },
        { "impasto",
          "min=0.008:max=0.05:brush=knife:length=0.6:tolerance=5:cover=1:opacity=1:impasto=0.9:jitter_colour=0.12:"
          "jitter_angle=0.5:jitter_size=0.3:canvas=source",
          "short thick strokes of a knife" },
        { "wash",
          "min=0.006:max=0.1:brush=wash:length=1:tolerance=4:cover=1:opacity=0.7:impasto=0:jitter_colour=0.12:"
          "jitter_angle=0.3:jitter_size=0.4:canvas=0.97,0.96,0.93",
          "thin washes on white paper, with dark rims" },
        { "pastel",
          "min=0.004:max=0.02:brush=chalk:length=1.2:tolerance=3:cover=0.9:opacity=1:impasto=0:jitter_colour=0.15:"
          "jitter_angle=0.3:jitter_size=0.3:canvas=0.5,0.46,0.42",
          "chalk on the tooth of grey-brown paper" },
        { "pointillist",
          "min=0.007:max=0.011:brush=round:length=0:tolerance=0:cover=0.97:opacity=1:impasto=0.2:jitter_colour=0.35:"
          "jitter_angle=0:jitter_size=0.3:canvas=0.93,0.91,0.86",
          "dots of one size in changing colours" },
    };
    return styles;
}

PaintOptions with_style(const PaintOptions& options)
{
    const PaintOptions unset;
    PaintOptions result = options;
    for (const Preset& style : paint_styles())
        if (options.style == style.name) {
            OptionTexts texts;
            PaintOptions row;
            std::string error;
            bool good = split_options(style.values, texts, error);
            for (const auto& [key, value] : texts)
                good = good && set_option(row, key, value, error);
            assert(good);
            for (const Option<PaintOptions>& option : option_table<PaintOptions>())
                if (option.get(row) != option.get(unset) && option.get(options) == option.get(unset))
                    option.set(result, option.get(row));
        }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
