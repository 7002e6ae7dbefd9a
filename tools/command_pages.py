#!/usr/bin/env python3
"""Makes manual pages and completions for bash and zsh from the --help of programs, so that they follow every change of an
option. The build runs it (cmake/PsygenManual.cmake).

usage: command_pages.py VERSION OUTPUT_DIR PROGRAM...

Writes NAME.1, NAME.bash and _NAME for each program. A program without readable help is an error.
"""
import dataclasses
import pathlib
import re
import subprocess
import sys


@dataclasses.dataclass
class Option:
    names: list        # "-h", "--help"; one word for a positional argument
    value: str         # the value's name; empty for a flag
    choices: list      # accepted values, if the help lists them
    text: str          # description, with range, default and needs


@dataclasses.dataclass
class Command:
    words: list        # "psygen", "history", "add"
    about: str = ""
    usage: str = ""
    arguments: list = dataclasses.field(default_factory=list)
    options: list = dataclasses.field(default_factory=list)
    commands: list = dataclasses.field(default_factory=list)
    footer: list = dataclasses.field(default_factory=list)


NEXT_LINE = " " * 30  # CLI11 begins descriptions in this column, on the next line after long options
NUMBERS = ("FLOAT", "UINT", "INT")


def entries(lines):
    """Pairs of the left and the right column of a section."""
    found = []
    for line, after in zip(lines, [*lines[1:], ""]):
        if line.startswith(NEXT_LINE):
            found[-1][1] = f"{found[-1][1]} {line.strip()}".strip()
            continue
        left, _, right = re.sub(r"\s{2,}", "\n", line.strip(), count=1).partition("\n")
        if not right and len(line) > len(NEXT_LINE) and not after.startswith(NEXT_LINE):
            left, right = line[:len(NEXT_LINE)].strip(), line[len(NEXT_LINE):]
        found.append([left, right])
    return found


def option_of(left, right):
    """An entry such as "--size TEXT:WxH=1280x720 Needs: --out" (CLI11) or "-h, --help", "--preset <preset>" (Qt)."""
    left = re.sub(r"\{false\}", "", left).replace(", -", ",-")
    notes = [f"{word[0].lower()}{word[1:]} {names.strip()}" for word, names in
             re.findall(r"(Needs|Excludes): ((?:--?[\w-]+ ?)+)", left)]
    left = re.sub(r"\s*(Needs|Excludes): .*", "", left)
    if left.endswith(" REQUIRED"):
        left, notes = left.removesuffix(" REQUIRED"), ["required", *notes]
    names, _, value = left.partition(" ")
    choices = []
    if value.endswith(" ..."):
        value, notes = value.removesuffix(" ..."), ["may be repeated", *notes]
    value, has_default, default = value.partition("=")
    if has_default:
        notes = [f"default: {default}", *notes]
    kind, _, label = value.partition(":")
    if kind in NUMBERS:
        value = "NUMBER"
        notes = [label.replace("FLOAT in ", ""), *notes] if label else notes
    elif kind == "TEXT":
        value = label.strip("{}").replace(",", "|") if label.startswith("{") else label or "TEXT"
        choices = value.split("|") if re.fullmatch(r"[a-z0-9]+(\|[a-z0-9]+)+", value) else []
    else:
        value = value.strip("<>").upper()
    text = right.rstrip(".")
    # "Quality: low, medium, high, ultra": the accepted values stand in the text.
    listed = re.search(r": (\w+(?:, \w+)+(?: or \w+)?)\b", right)
    if not choices and listed and value and names.endswith("preset"):
        choices = re.split(r", | or ", listed[1])
    return Option(names.split(","), value, choices, f"{text} ({'; '.join(notes)})" if notes else text)


def read_help(path, words):
    """The command `words` and those below it."""
    asked = subprocess.run([path, *words[1:], "--help"], capture_output=True, text=True, check=True)
    command, section, sections = Command(words), "", {}
    for line in asked.stdout.splitlines():
        heading = re.fullmatch(r"(Options|Positionals|Arguments|Subcommands):", line)
        if heading:
            section = heading[1]
            sections[section] = []
        elif line.startswith("Usage: "):
            command.usage = re.sub(r"^Usage: \S+", words[0], line)
        elif section and line.startswith(" ") and not command.footer:
            sections[section].append(line)
        elif line and section:
            command.footer.append(line)
        elif line and not command.about:
            command.about = re.sub(rf"^{words[0]}: ", "", line).rstrip(".")
        elif command.footer:
            command.footer.append(line)
    command.options = [option_of(*entry) for entry in entries(sections.get("Options", []))]
    command.arguments = [option_of(*entry) for entry in
                         entries(sections.get("Positionals", sections.get("Arguments", [])))]
    if not command.about or not command.usage or not command.options:
        sys.exit(f"command_pages: the help of {' '.join(words)} is not readable")
    command.commands = [read_help(path, [*words, name]) for name, _ in entries(sections.get("Subcommands", []))]
    return command


def all_of(command):
    yield command
    for below in command.commands:
        yield from all_of(below)


# ---------------------------------------------------------------- manual page

def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def page_entries(options):
    for option in options:
        names = ", ".join(f"\\fB{roff(name)}\\fR" for name in option.names)
        value = f" \\fI{roff(option.value)}\\fR" if option.value else ""
        yield from (".TP", names + value, roff(option.text))


def page_of(top, version):
    name = top.words[0]
    lines = [f'.TH {roff(name.upper())} 1 "" "psygen {version}" "User Commands"', ".SH NAME",
             f"{roff(name)} \\- {roff(top.about)}", ".SH SYNOPSIS", f".B {roff(top.usage)}"]
    for title, options in (("ARGUMENTS", top.arguments), ("OPTIONS", top.options)):
        if options:
            lines += [f".SH {title}", *page_entries(options)]
    if top.commands:
        lines.append(".SH COMMANDS")
    for command in list(all_of(top))[1:]:
        lines += [f".SS {roff(command.usage)}", roff(command.about) + ".",
                  *page_entries(command.arguments), *page_entries(command.options)]
    for line in top.footer:
        if line.endswith(":"):
            lines.append(f".SH {line[:-1].upper()}")
        elif line.startswith("  "):
            lines += [".nf", roff(line.strip()), ".fi"]
        else:
            lines += [".PP", roff(line)]
    return "\n".join(lines) + "\n"


# ---------------------------------------------------------------- completion

SHIPPED = {"world": "worlds", "path": "paths"}  # options and arguments whose values may be names of files of psygen


def names_of(command):
    return [option.names[-1] for option in command.options]  # the long one


def valued(command):
    """Options of a command that take a value: pattern, accepted values, folder of data, whether a file may follow."""
    for option in command.options:
        if option.value:
            folder = SHIPPED.get(option.names[-1].lstrip("-"))
            yield "|".join(f'"{" ".join(command.words)} {name}"' for name in option.names), \
                option.choices, folder, option.value == "TEXT"


def value_cases(top):
    """Lines of a case statement over "COMMAND OPTION"; the functions that they call differ by shell."""
    for command in all_of(top):
        for pattern, choices, folder, is_text in valued(command):
            if folder:
                yield f"    {pattern}) _psygen_shipped {folder}; _psygen_files ;;"
            elif choices:
                yield f"    {pattern}) _psygen_values {' '.join(choices)} ;;"
            else:
                yield f"    {pattern}) {'_psygen_files' if is_text else ':'} ;;"


BASH = r"""# Completion of @NAME@ for bash, made from its --help.
_@ID@() {
  local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD - 1]}" command="@NAME@" known i
  # bash splits "--option=value" into three words.
  if [ "$word" = = ]; then word=""; elif [ "$before" = = ]; then before="${COMP_WORDS[COMP_CWORD - 2]}"; fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${COMP_WORDS[i]}" in
      @COMMANDS@) command+=" ${COMP_WORDS[i]}" ;;
    esac
  done
  _psygen_values() { mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$*" -- "$word"); }
  _psygen_files() { compopt -o filenames 2>/dev/null; mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$word"); }
  _psygen_shipped() {
    known="$(dirname "$(readlink -f "$(type -P @NAME@)")")/../share/psygen/$1"
    _psygen_values "$(cd "$known" 2>/dev/null && printf '%s\n' *.toml | sed 's/\.toml$//')"
  }
  COMPREPLY=()
  case "$command $before" in
@VALUES@
    *) case "$command" in
@WORDS@
      esac ;;
  esac
  unset -f _psygen_values _psygen_files _psygen_shipped
}
complete -F _@ID@ @NAME@
"""

ZSH = r"""#compdef @NAME@
# Completion of @NAME@ for zsh, made from its --help.
_@ID@() {
  local command="@NAME@" word
  local -a candidates
  for word in "${(@)words[2,CURRENT-1]}"; do
    case "$command $word" in
      @COMMANDS@) command+=" $word" ;;
    esac
  done
  _psygen_values() { compadd -- "$@" }
  _psygen_files() { _files }
  _psygen_shipped() {
    local folder="${$(whence -p @NAME@):A:h:h}/share/psygen/$1"
    compadd -- "$folder"/*.toml(N:t:r)
  }
  case "$command ${words[CURRENT-1]}" in
@VALUES@
    *) case "$command" in
@WORDS@
      esac ;;
  esac
  unfunction _psygen_values _psygen_files _psygen_shipped
}
_@ID@ "$@"
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def bash_words(top):
    for command in all_of(top):
        words = names_of(command) + [below.words[-1] for below in command.commands]
        extra = "".join(f" _psygen_shipped {SHIPPED[a.names[0]]};" for a in command.arguments if a.names[0] in SHIPPED)
        files = " _psygen_files" if command.arguments and not command.commands else ""
        yield f'      "{" ".join(command.words)}") _psygen_values {" ".join(words)};{extra}{files} ;;'


def zsh_words(top):
    def described(name, text):
        return quoted(name.replace(":", "\\:") + ":" + text)

    for command in all_of(top):
        below = [described(c.words[-1], c.about) for c in command.commands]
        options = [described(name, option.text) for option in command.options for name in option.names[-1:]]
        lines = [f"candidates=({' '.join(below)}); _describe command candidates;"] if below else []
        lines.append(f"candidates=({' '.join(options)}); _describe -o option candidates;")
        lines += [f"_psygen_shipped {SHIPPED[a.names[0]]};" for a in command.arguments if a.names[0] in SHIPPED]
        if command.arguments and not below:
            lines.append("_psygen_files;")
        yield f'      "{" ".join(command.words)}") ' + " ".join(lines) + ";"


def script(template, top, words):
    commands = "|".join(f'"{" ".join(command.words)}"' for command in list(all_of(top))[1:]) or '""'
    filled = {"NAME": top.words[0], "ID": top.words[0].replace("-", "_"), "COMMANDS": commands,
              "VALUES": "\n".join(value_cases(top)), "WORDS": "\n".join(words)}
    return re.sub(r"@(\w+)@", lambda match: filled[match[1]], template)


def main():
    version, folder, *programs = sys.argv[1:]
    output = pathlib.Path(folder)
    output.mkdir(parents=True, exist_ok=True)
    for program in programs:
        name = pathlib.Path(program).name
        top = read_help(program, [name])
        for file, text in ((f"{name}.1", page_of(top, version)), (f"{name}.bash", script(BASH, top, bash_words(top))),
                           (f"_{name}", script(ZSH, top, zsh_words(top)))):
            (output / file).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
