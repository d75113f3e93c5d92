// SPDX-License-Identifier: BSD-3-Clause
// The grammar of option text: a table of cases.
#include <pimg/option_text.h>

#include <gtest/gtest.h>

namespace pimg {
namespace {

using Pairs = OptionTexts;

TEST(OptionText, IsSplitByItsRules)
{
    const struct {
        const char* text;
        char separator;
        Pairs expected;
    } cases[] = {
        { "", ':', {} },
        { "a=1", ':', { { "a", "1" } } },
        { "a=1:b=x y", ':', { { "a", "1" }, { "b", "x y" } } },
        { "a=:b=", ':', { { "a", "" }, { "b", "" } } },
        { "a=b=c", ':', { { "a", "b=c" } } },
        { "curve=0:1,1:3:gain=2", ':', { { "curve", "0:1,1:3" }, { "gain", "2" } } },
        { "zones=-6:+2,0:-.5:b=1", ':', { { "zones", "-6:+2,0:-.5" }, { "b", "1" } } },
        { "a=\"x:y\":b=1", ':', { { "a", "x:y" }, { "b", "1" } } },
        { "a='x:y'", ':', { { "a", "x:y" } } },
        { "a=\"\"", ':', { { "a", "" } } },
        { "a=\"\"\"\"", ':', { { "a", "\"" } } },
        { "a=\"say \"\"x:y\"\"\":b=2", ':', { { "a", "say \"x:y\"" }, { "b", "2" } } },
        { "a='it''s'", ':', { { "a", "it's" } } },
        { "a=\"C:\\b\\c\"", ':', { { "a", "C:\\b\\c" } } },
        { "a=5\"", ':', { { "a", "5\"" } } },
        { "a='\"'", ':', { { "a", "\"" } } },
        { "a=x:y&b=1", '&', { { "a", "x:y" }, { "b", "1" } } },
        { "a=\"x&y\"&b=1", '&', { { "a", "x&y" }, { "b", "1" } } },
        { "a=1&9=2", '&', { { "a", "1" }, { "9", "2" } } },
    };
    for (const auto& c : cases) {
        Pairs pairs;
        std::string error;
        EXPECT_TRUE(split_options(c.text, pairs, error, c.separator)) << c.text << ": " << error;
        EXPECT_EQ(pairs, c.expected) << c.text;
    }
}

TEST(OptionText, ErrorsAreOneLineThatNamesTheKey)
{
    const struct {
        const char* text;
        const char* named;
        const char* expected;
    } cases[] = {
        { "a", "\"a\"", "key=value" },
        { "=1", "\"=1\"", "key=value" },
        { ":", "\"\"", "key=value" },
        { "a=1:", "\"\"", "key=value" },
        { "a=1::b=2", "\"\"", "key=value" },
        { "a=x:y", "\"y\"", "key=value" },
        { "a=1:b:c=2", "\"b\"", "key=value" },
        { "key=\"x", "key", "quotation marks" },
        { "key='x\"", "key", "quotation marks" },
        { "key=\"x\"y", "key", "quotation marks" },
        { "key=\"\"\"", "key", "quotation marks" },
    };
    for (const auto& c : cases) {
        Pairs pairs;
        std::string error;
        EXPECT_FALSE(split_options(c.text, pairs, error)) << c.text;
        EXPECT_NE(error.find(c.named), error.npos) << c.text << ": " << error;
        EXPECT_NE(error.find(c.expected), error.npos) << c.text << ": " << error;
        EXPECT_EQ(error.find('\n'), error.npos) << c.text;
    }
}

}  // namespace
}  // namespace pimg
