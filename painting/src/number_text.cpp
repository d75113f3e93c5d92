// SPDX-License-Identifier: BSD-3-Clause
#include "number_text.h"

#include <cmath>
#include <cstdlib>

namespace pimg {
inline namespace PIMG_ABI {

void append_number(std::string& text, double value, int decimals)
{
    const long scale = decimals > 2 ? 1000 : 100, units = std::lround(value * double(scale));
    long rest = std::labs(units % scale);
    if (units < 0 && units / scale == 0)
        text += '-';
    text += std::to_string(units / scale);
    for (long digit = scale / 10; rest > 0; rest %= digit, digit /= 10) {
        if (digit == scale / 10)
            text += '.';
        text += char('0' + rest / digit);
    }
}

std::string hexadecimal(const std::array<float, 3>& colour)
{
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text = "#";
    for (const float value : colour) {
        text += kDigits[byte_of(value) >> 4];
        text += kDigits[byte_of(value) & 15];
    }
    return text;
}

int byte_of(float value)
{
    return value > 0.0f ? int(std::lround(255.0f * (value < 1.0f ? value : 1.0f))) : 0;
}

}  // namespace PIMG_ABI
}  // namespace pimg
