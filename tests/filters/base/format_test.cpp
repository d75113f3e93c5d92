// SPDX-License-Identifier: BSD-3-Clause
// Messages as users see them: one line of bounded length, whatever is quoted.
#include <pimg/detail/format.h>

#include <gtest/gtest.h>

namespace pimg {
namespace {

TEST(OneLine, LeavesOrdinaryMessagesAlone)
{
    for (const char* message : { "", "level: expected 0 to 1, not \"2\"", "\"bl\xc3\xa4.png\": no such file" })
        EXPECT_EQ(one_line(message), message);
}

TEST(OneLine, HoldsNoControlCharacters)
{
    EXPECT_EQ(one_line("first\nsecond\tthird\x1b[2J\n\n"), "first second?third?[2J");
    EXPECT_EQ(one_line(std::string("a\0b", 3)), "a?b");
}

TEST(FirstLine, LeavesTheRestAway)
{
    EXPECT_EQ(first_line("no such file\n  perhaps you meant\n  another"), "no such file");
    EXPECT_EQ(first_line("one line"), "one line");
    EXPECT_EQ(first_line(""), "");
}

TEST(OneLine, IsOfBoundedLengthAndKeepsBothEnds)
{
    const std::string word = one_line("cannot read \"" + std::string(5000, 'x') + ".exr\": no such file");
    EXPECT_LE(word.size(), 350u);
    EXPECT_EQ(word.find("cannot read \"xxx"), 0u);
    EXPECT_NE(word.find("x.exr\": no such file"), word.npos);
    std::string words = "begin";
    for (int i = 0; i < 5000; ++i)
        words += " word";
    words = one_line(words + " end");
    EXPECT_LE(words.size(), 1500u);
    EXPECT_EQ(words.find("begin word"), 0u);
    EXPECT_EQ(words.rfind("word end"), words.size() - 8);
}

}  // namespace
}  // namespace pimg
