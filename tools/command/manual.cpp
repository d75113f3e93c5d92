// SPDX-License-Identifier: BSD-3-Clause
// The manual page and the completion of bash, from the command table.
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/version.h>

#include "command/command.h"
#include "command/help.h"
#include "session/output.h"

namespace pimgtool {

namespace {

using pimg::format;

/// Text as roff takes it.
std::string roff(const std::string& text)
{
    std::string result;
    for (const char c : text)
        result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    return result.empty() || (result[0] != '.' && result[0] != '\'') ? result : "\\&" + result;
}

std::string manual_of(const Command& command)
{
    const std::string words = *command.words == '\0' ? "" : format(" \\fI{}\\fR", roff(command.words));
    std::string text = format(".TP\n\\fB{}\\fR{}{}\n{}\n", roff(command.name), command.keys ? "[:key=value...]" : "",
                              words, roff(command.help));
    if (!command.keys)
        return text;
    text += ".RS\n";
    for (const pimg::OptionInfo& key : command.keys())
        text += format(".TP\n\\fB{}\\fR=\\fI{}\\fR\n{} ({})\n", roff(key.key), roff(key.default_value), roff(key.help),
                       roff(values_of(key)));
    if (command.presets)  // a space for each colon, since lines break at spaces
        for (const pimg::Preset& preset : command.presets())
            text += format(".TP\n{}\n{}: {}\n", roff(std::string("style=") + preset.name), roff(preset.summary),
                           roff(OIIO::Strutil::replace(preset.values, ":", " ", true)));
    return text + ".RE\n";
}

/// In single quotes.
std::string quoted(const std::string& text)
{
    return "'" + OIIO::Strutil::replace(text, "'", "'\\''", true) + "'";
}

/// The words that may stand in place of a word of this name.
std::string choices_for(const std::string& word)
{
    return word == "TYPE" ? OIIO::Strutil::replace(kOutputTypes, ",", "", true) : "";
}

}  // namespace

std::string manual_page()
{
    std::string text = format(".TH PIMGTOOL 1 \"\" \"pimg {}\"\n", PIMG_VERSION_STRING);
    text +=
        ".SH NAME\npimgtool \\- HDR compression, smoothing, enhancement and painting with progressive images\n"
        ".SH SYNOPSIS\n\\fBpimgtool\\fR \\fIINPUT\\fR [\\fB\\-\\-operation\\fR[:key=value...]]... "
        "\\fB\\-o\\fR \\fIOUTPUT\\fR ...\n"
        ".SH DESCRIPTION\nArguments are taken from left to right: a file name puts a picture on the stack, an "
        "operation\n"
        "replaces the picture on top, \\fB\\-o\\fR writes it. Any format OpenImageIO knows can be read and written.\n"
        "Keys are shown with their defaults.\n";
    for (const CommandGroup& group : command_table()) {
        text += format(".SS {}\n", roff(group.title));
        for (const Command& command : group.commands)
            text += manual_of(command);
    }
    text += ".SH EXAMPLES\n.nf\n"
            "pimgtool in.exr \\-\\-hdr\\-compress:beta=10 \\-o out.png\n"
            "pimgtool in.exr \\-\\-hdr\\-compress \\-\\-ociodisplay default default \\-o out.png\n"
            "pimgtool \\-\\-frames 1\\-240 in.#.exr \\-\\-hdr\\-compress \\-\\-shot\\-stats shot.json \\-o out.#.exr\n"
            ".fi\n"
            ".SH ENVIRONMENT\n.TP\n\\fBOCIO\\fR\nOpenColorIO configuration to use\n"
            ".SH EXIT STATUS\n0 if all went well; 1 and one line on standard error if not, and then no file is left "
            "half written.\n"
            ".SH SEE ALSO\n\\fBoiiotool\\fR(1)\n";
    return text;
}

/// The function for bash after its tables. Bash replaces only the part of a word after the last of its word breaks,
/// among which are ':' and '='.
static constexpr char kCompletion[] = R"BASH(    local line=${COMP_LINE:0:COMP_POINT}
    local word=${line##* } before=${line% *}
    local previous=${before##* } choices done_part=
    COMPREPLY=()
    if [[ -n ${words[$previous]-} ]]; then
        choices=${words[$previous]}
    elif [[ $word == -*:*=* && ${word##*:} == *=* ]]; then
        local key=${word##*:}
        done_part=${word%"${word##*=}"}
        choices=${values[${word%%:*}:${key%%=*}]-}
    elif [[ $word == -*:* ]]; then
        done_part=${word%"${word##*:}"}
        choices=${keys[${word%%:*}]-}
        compopt -o nospace 2>/dev/null
    elif [[ $word == -* ]]; then
        choices=$names
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
        compopt -o filenames 2>/dev/null
        return
    fi
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "${word#"$done_part"}")
}
complete -F _pimgtool pimgtool
)BASH";

std::string bash_completion()
{
    std::string names, keys, values, words;
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands) {
            names += format(" {}", command.name);
            const std::string choices = choices_for(command.words);
            if (!choices.empty())
                words += format("        [{}]={}\n", command.name, quoted(choices));
            if (!command.keys)
                continue;
            std::string own;
            for (const pimg::OptionInfo& key : command.keys()) {
                own += format("{}{}=", own.empty() ? "" : " ", key.key);
                const std::string chosen = key.type == "flag" ? "0|1" : key.choices;
                if (!chosen.empty())
                    values += format("        [{}:{}]={}\n", command.name, key.key,
                                     quoted(OIIO::Strutil::replace(chosen, "|", " ", true)));
            }
            keys += format("        [{}]={}\n", command.name, quoted(own));
        }
    return "# Completion of pimgtool for bash.\n"
           "_pimgtool() {\n"
           "    local names="
        + quoted(names.substr(1))
        + "\n"
          "    local -A keys=(\n"
        + keys + "    ) values=(\n" + values + "    ) words=(\n" + words + "    )\n" + kCompletion;
}

}  // namespace pimgtool
