#!/usr/bin/env python3
"""Counts the figures of style that docs/architecture.md lists ("Figures of the house") and fails beyond their
limits. MEASURES at the end names each figure, its limit and its rule.

usage: style_test.py SOURCE_DIR                              hold every figure to its limit
       style_test.py --report SOURCE_DIR [FOLDER] [--names FILE]   print figures, and where they are worst
       style_test.py --list FIGURE SOURCE_DIR [FOLDER]       print each place of one figure
       style_test.py --report SOURCE_DIR --by-folder         one line a folder
       style_test.py --self-test

FOLDER is a path below SOURCE_DIR. Rules read texts, not a compiler's tree: they are exact for the style that
tools/format.sh produces. FILE has one old name a line, for a rename under way.
"""
import bisect
import collections
import functools
import pathlib
import re
import sys

CODE = ("ecs", "engine", "editor", "game")
CXX = (".hpp", ".cpp", ".h", ".inl")
SHADERS = (".vert", ".frag", ".comp", ".glsl")
SCRIPTS = (".py", ".sh", ".cmake")
PAGES = (".js", ".css")  # of HTML pages that C++ embeds
SKIPPED = {"build", ".git", "out", "__pycache__"}

# ---------------------------------------------------------------- texts of the tree

COMMENT_OR_STRING = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^\s()\\]{0,16})\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", re.S)


class Tree:
    """The files below a root, read once. Keys are paths relative to the root."""

    def __init__(self, files):
        self.files = dict(sorted(files.items()))
        self.blank_cache, self.functions_cache = {}, {}
        self.missing = []  # what a figure looked for in vain: then its value means nothing

    @staticmethod
    def read(root):
        files = {}
        for top in (*CODE, "tests", "examples", "shaders", "docs", "tools", "cmake", ".ci", ""):
            folder = root / top
            for file in (folder.rglob("*") if top else folder.glob("*")):
                relative = file.relative_to(root)
                if SKIPPED & set(relative.parts) or not file.is_file():
                    continue
                if file.suffix in CXX + SHADERS + SCRIPTS + PAGES + (".md",) or file.name == "CMakeLists.txt" or \
                        relative.as_posix() == ".ci/run":
                    files[relative.as_posix()] = file.read_text(encoding="utf-8", errors="replace")
        return Tree(files)

    def select(self, tops, suffixes):
        found = [(name, text) for name, text in self.files.items()
                 if name.endswith(suffixes) and name.split("/")[0] in tops]
        for top in set(tops) - {name.split("/")[0] for name, _ in found}:
            self.need(False, f"{'/'.join(suffixes)} file in {top}/")
        return found

    def need(self, found, what):
        """Notes that a figure found nothing to count in."""
        if not found:
            self.missing.append(what)
        return found

    def blank(self, name):
        """The C++ of a file with comments, the contents of literals and preprocessor lines made empty."""
        if name not in self.blank_cache:
            text = COMMENT_OR_STRING.sub(blank_match, self.files[name])
            self.blank_cache[name] = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", "", text, flags=re.M)
        return self.blank_cache[name]

    def functions(self, name):
        if name not in self.functions_cache:
            self.functions_cache[name] = list(functions_of(self.blank(name)))
        return self.functions_cache[name]


def blank_match(match):
    """A comment becomes its line ends; a literal becomes "" or ' ' with its line ends behind it."""
    text = match.group(0)
    lines = "\n" * text.count("\n")
    if text.startswith(("//", "/*")):
        return lines
    return ('""' if text.startswith(('"', "R")) else "' '") + lines


# ---------------------------------------------------------------- prose

def prose_of_cxx(text):
    """Comments and literals of three or more words. Lines of a comment, and adjacent literals, are one text."""
    out, last_end, last_kind = [], -1, ""
    for match in COMMENT_OR_STRING.finditer(text):
        piece = match.group(0)
        between = text[last_end:match.start()] if last_end >= 0 else "x"
        if piece.startswith("//"):
            body = piece[2:].lstrip("/!<").strip()
            own_line = not text[text.rfind("\n", 0, match.start()) + 1:match.start()].strip()
            joins = last_kind == "//" and own_line and not between.strip() and between.count("\n") == 1
            kind = "//"
        elif piece.startswith("/*"):
            body, joins, kind = re.sub(r"\n\s*\*?", " ", piece[2:-2]), False, "/*"
        elif piece.startswith("'"):
            last_end, last_kind = match.end(), "'"
            continue
        else:
            raw = piece.startswith("R")
            body = piece[piece.find("(") + 1:piece.rfind(")")] if raw else \
                piece[1:-1].replace("\\n", "\n\n").replace('\\"', '"')
            joins, kind = last_kind == '"' and not between.strip(), '"'
        if joins and out:
            position, before = out[-1][1], out[-1][2]
            out[-1] = (kind, position, before + ("" if kind == '"' else "\n" if body else "\n\n") + body)
        else:
            out.append((kind, match.start(), body))
        last_end, last_kind = match.end(), kind
    for kind, position, body in out:
        if kind == '"' and (len(re.findall(r"[A-Za-z]{2,}", body)) < 3 or " " not in body):
            continue
        yield position, body


def prose_of_script(text):
    """Comments of Python, shell and CMake; Python's docstrings as well."""
    for match in re.finditer(r'"""(.*?)"""', text, re.S):
        yield match.start(), match.group(1)
    for match in re.finditer(r"(?:^[ \t]*#(?!!)[^\n]*\n)+|[ \t]#[ \t][^\n]*\n", text, re.M):
        yield match.start(), re.sub(r"^[ \t]*#+", "", match.group(0), flags=re.M)


def prose_of_markdown(text):
    """Paragraphs, items, headings and cells of tables, without blocks of code."""
    text = re.sub(r"^```.*?^```", lambda m: re.sub(r"[^\n]", " ", m.group(0)), text, flags=re.S | re.M)
    block, start, at = [], 0, 0
    for line in text.split("\n") + [""]:
        cell_line = line.lstrip().startswith("|")
        fresh = re.match(r"\s*([-*+]|\d+\.)\s|#+ |>", line)
        if (not line.strip() or cell_line or fresh) and block:
            yield start, " ".join(block)
            block = []
        if cell_line:
            for cell in line.strip().strip("|").split("|"):
                if re.search(r"[A-Za-z]{2}", cell):
                    yield at, cell.strip()
        elif line.strip():
            if not block:
                start = at
            block.append(re.sub(r"^\s*([-*+]|\d+\.|#+|>)\s+", "", line).strip())
            if line.startswith("#"):
                yield start, " ".join(block)
                block = []
        at += len(line) + 1


def prose(name, text):
    if name.endswith(CXX + SHADERS + PAGES):
        return prose_of_cxx(text)
    return prose_of_markdown(text) if name.endswith(".md") else prose_of_script(text)


SENTENCE_END = re.compile(r"(?<=[.!?])[)\"'”*_`]*\s+(?=[\"'“(*_`]*[A-Z0-9])|\n\s*\n|\n\s*[-*]\s")
ABBREVIATION = re.compile(r"(?:\b(?:e\.g|i\.e|cf|etc|vs|Fig|No|Dr|St)\.|\b[A-Z]\.)[)\"']*$")


def sentences(text):
    """(offset, sentence) of a text: ends are ., ! and ? before a capital, empty lines, and items."""
    start = 0
    for match in SENTENCE_END.finditer(text):
        piece = text[start:match.start()]
        if "\n" not in match.group(0).strip(" ") and ABBREVIATION.search(piece.rstrip()):
            continue
        if piece.strip():
            yield start, " ".join(piece.split())
        start = match.end()
    if text[start:].strip():
        yield start, " ".join(text[start:].split())


WORD = re.compile(r"[A-Za-zÀ-ÿ][\w'’.:/-]*")
OPENER = re.compile(r"^[\"'“(*_`]*(What|Whatever|Whether|Who|Whoever|Whom|Whose|Whichever|Where|Wherever|How|Nobody)\b(?!-)"
                    r"(?P<rest>.*)$", re.S)


def opens_with_a_noun_clause(sentence):
    """True for "What is predicted may go …". False for a question, for "How to …", for "Where a, b" (an
    adverbial clause), and for "Who" or "What" followed by a mark."""
    match = OPENER.match(sentence)
    if not match or sentence.rstrip("\"'”)*_`").endswith("?"):
        return False
    word, rest = match.group(1), match.group("rest")
    if word in ("Where", "Wherever") and "," in rest:
        return False
    return bool(re.match(r"\s+\w", rest)) and not re.match(r"\s+to\b", rest) or word in ("Whatever", "Nobody")


def language_files(tree):
    """Files whose prose counts: all but this one, which quotes what it forbids."""
    for name, text in tree.files.items():
        if name != "tests/tools/style_test.py":
            yield name, text


def noun_clauses(tree):
    """Per file: places, and words."""
    for name, text in language_files(tree):
        words, found = 0, []
        for position, body in prose(name, text):
            words += len(WORD.findall(body))
            for offset, sentence in sentences(body):
                if opens_with_a_noun_clause(sentence):
                    found.append((position + offset, sentence[:110]))
        yield name, places(text, found), words


def places(text, found):
    """(line, what) of offsets into a text."""
    ends = [match.start() for match in re.finditer("\n", text)]
    return [(bisect.bisect_left(ends, offset) + 1, what) for offset, what in found]


def long_sentences(tree, page, limit=25):
    """Places of sentences over a limit of words, and the count of all. A code span or a link is one word."""
    text = tree.need(tree.files.get(page), page) or ""
    found, total = [], 0
    for position, body in prose_of_markdown(text):
        body = re.sub(r"\]\([^)]*\)", "]", re.sub(r"`[^`]*`", "Code", body))
        for offset, sentence in sentences(body):
            words = len(re.findall(r"[\w’'/.-]*\w[\w’'/.-]*", sentence))
            if words < 3:
                continue
            total += 1
            if words > limit:
                found.append((position, f"{words} words: {sentence[:90]}"))
    return places(text, found), total


# ---------------------------------------------------------------- shapes

TOKEN = re.compile(r"[A-Za-z_]\w*|\d[\w.'+-]*|::|->|\[\[|\]\]|&&|<<=|>>=|==|!=|<=|>=|\S|\n")
CONTROL = {"if", "for", "while", "switch", "return", "catch", "sizeof", "alignof", "decltype", "static_assert",
           "noexcept", "alignas", "requires", "new", "delete", "throw", "co_return", "else", "do", "case",
           "__attribute__", "explicit"}


def functions_of(text):
    """(line, qualified name, parameters) of each declaration and definition at namespace or class scope.
    Macros that look like functions (TEST, Q_OBJECT) are left out by their capitals."""
    line, tokens = 1, []
    for match in TOKEN.finditer(text):
        if match.group(0) == "\n":
            line += 1
        else:
            tokens.append((match.group(0), line))
    i, statement, scopes = 0, [], []
    while i < len(tokens):
        token = tokens[i][0]
        if token == "{":
            words = [t for t, _ in statement]
            head = without_template(words)
            if not head or head[0] in ("namespace", "inline", "extern") and "(" not in head:
                scopes.append("namespace")
                statement = []
            elif "(" not in without_attributes(head) and set(head) & {"class", "struct", "union"} and "=" not in head:
                scopes.append("class")
                statement = []
            elif "(" in head and function_head(statement):
                yield from function_at(statement)
                if in_initialisers(words):  # the braces of one member: a constructor goes on
                    i = skip(tokens, i, "{", "}")
                    statement = [*statement, ("{}", tokens[i - 1][1])]
                    continue
                i = skip(tokens, i, "{", "}")
                statement = []
                continue
            else:  # an enum, or the braces of a value
                i = skip(tokens, i, "{", "}")
                statement = [*statement, ("{}", tokens[i - 1][1])]
                continue
        elif token == "}":
            if scopes:
                scopes.pop()
            statement = []
        elif token == ";":
            if "(" in [t for t, _ in statement] and function_head(statement):
                yield from function_at(statement)
            statement = []
        elif token == ":" and len(statement) == 1 and statement[0][0] in ("public", "private", "protected", "signals"):
            statement = []
        elif token == "(":
            end = skip(tokens, i, "(", ")")
            statement += tokens[i:end]
            i = end
            continue
        else:
            statement.append(tokens[i])
        i += 1


def skip(tokens, i, opens, closes):
    """The index behind the bracket that closes the one at i."""
    depth = 0
    while i < len(tokens):
        depth += (tokens[i][0] == opens) - (tokens[i][0] == closes)
        i += 1
        if depth == 0:
            break
    return i


def without_template(words):
    while words and words[0] == "template":
        depth, k = 0, 1
        while k < len(words):
            depth += words[k].count("<") - (words[k].count(">") if words[k] != "->" else 0)
            k += 1
            if depth <= 0:
                break
        words = words[k:]
    return words


def without_attributes(words):
    out, depth = [], 0
    for word in words:
        depth += (word == "[[") - (word == "]]")
        if depth == 0 and word != "]]":
            out.append(word)
    return [w for k, w in enumerate(out) if not (w == "alignas" or "alignas" in out[max(0, k - 4):k])]


def parameter_list(statement):
    """(index of the name, index of its bracket) of the first bracket that a function's name stands before."""
    words = [t for t, _ in statement]
    depth, k = 0, 0
    if words[:1] == ["template"]:
        k = len(words) - len(without_template(words))
    angle = 0
    while k < len(words):
        word = words[k]
        if word == "[[":
            while k < len(words) and words[k] != "]]":
                k += 1
        elif word == "<" and k and words[k - 1] != "operator":
            angle += 1
        elif word == ">" and angle:
            angle -= 1
        elif word in ("=", "{}") and depth == 0 and angle == 0 and (k == 0 or words[k - 1] != "operator"):
            return None
        elif word == "(" and angle == 0 and k:
            name = words[k - 1]
            if name in ("alignas", "noexcept", "decltype", "requires", "explicit", "__attribute__"):
                k = skip(statement, k, "(", ")")
                continue
            return (k - 1, k) if re.match(r"[A-Za-z_]\w*$", name) and name not in CONTROL else None
        k += 1
    return None


def function_head(statement):
    at = parameter_list(statement)
    if at is None:
        return False
    name = statement[at[0]][0]
    alone = at[0] == 0 and not (len(statement) > at[1] + 1)
    return not alone and not re.match(r"[A-Z][A-Z0-9_]{2,}$", name)


def in_initialisers(words):
    """True if the brace behind these words belongs to a member of a constructor's list."""
    depth, colon = 0, False
    for k, word in enumerate(words):
        depth += (word == "(") - (word == ")")
        if word == ":" and depth == 0 and ")" in words[:k] and "?" not in words[:k]:
            colon = True
    return colon and bool(words) and words[-1] not in (")", "{}") and (words[-1] not in ("const", "noexcept"))


def function_at(statement):
    k, bracket = parameter_list(statement)
    end = skip(statement, bracket, "(", ")")
    words = [t for t, _ in statement]
    name = words[k]
    while k >= 2 and words[k - 1] == "::" and re.match(r"\w+$", words[k - 2]):
        k -= 2
        name = words[k] + "::" + name
    parameters, depth, current = [], 0, []
    for word in words[bracket + 1:end - 1]:
        depth += (word in "([{<") - (word in ")]}>") if len(word) == 1 else 0
        if word == "," and depth == 0:
            parameters.append(" ".join(current))
            current = []
        else:
            current.append(word)
    if current:
        parameters.append(" ".join(current))
    if parameters == ["void"]:
        parameters = []
    if all(looks_like_parameter(p) for p in parameters):
        yield statement[k][1], name, parameters


def looks_like_parameter(text):
    """False for the arguments of a variable's constructor: a number, a literal or an expression."""
    first = text.split(" ")[0]
    return not re.match(r'[\d"\'&*!-]', first) and " . " not in text and " + " not in text.split(" = ")[0]


def is_kernel(tree, name, line):
    """True inside HWY_NAMESPACE: Highway compiles these functions for each instruction set. They pass lanes by value."""
    text = tree.blank(name)
    opened = re.search(r"\bHWY_NAMESPACE\s*(?=\{)", text)
    if not opened:
        return False
    first = text.count("\n", 0, opened.end()) + 1
    return first < line <= first + text[opened.end():closing(text, opened.end())].count("\n")


def by_function(tree, tops, condition):
    """One place for each function (a declaration and its definition are one) that meets a condition."""
    seen = {}
    for name, _ in tree.select(tops, CXX):
        for line, function, parameters in tree.functions(name):
            why = condition(name, line, parameters)
            if why:
                key = (function.rsplit("::", 1)[-1], len(parameters), tuple(p.split(" =")[0].strip() for p in parameters))
                seen.setdefault(key, (name, line, f"{function}: {why}"))
    return collect(seen.values())


def collect(found):
    out = collections.defaultdict(list)
    for name, line, what in found:
        out[name].append((line, what))
    return out


def long_parameter_lists(tree):
    return by_function(tree, CODE, lambda name, line, p: f"{len(p)} parameters" if len(p) > 7 and not is_kernel(tree, name, line) else "")


def neighbouring_bools(tree):
    def why(_, __, parameters):
        kinds = [re.match(r"(const )?bool( \w+)?( = .*)?$", p) for p in parameters]
        return "neighbouring bools" if any(a and b for a, b in zip(kinds, kinds[1:])) else ""
    return by_function(tree, CODE, why)


KINDS = [("number", re.compile(r"[-+]?\.?\d[\w.']*(?:[eE][-+]?\d+f?)?$")), ("bool", re.compile("true$|false$")),
         ("pointer", re.compile("nullptr$")), ("text", re.compile(r'(?:u8|[LuU])?(?:""\s*)+(?:sv|s)?$')),
         ("number", re.compile(r"(?:u8|[LuU])?' '$"))]  # a character: bytes of files mix both


def closing(text, opened):
    """The offset of the brace that closes the one at an offset, or the end of the text."""
    depth = 0
    for match in re.finditer(r"[{}]", text[opened:]):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return opened + match.start()
    return len(text)


def items_of(text):
    """Texts between the commas outside of brackets."""
    items, depth, start = [], 0, 0
    for k, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            items.append(text[start:k].strip())
            start = k + 1
    return [*items, text[start:].strip()] if text[start:].strip() else items


def kind_of(item):
    """The kind of a bare value, or None: a literal, or braces that hold bare values only."""
    if item.startswith("{") and item.endswith("}"):
        inner = items_of(item[1:-1])
        return "braces" if inner and all(kind_of(value) for value in inner) else None
    return next((kind for kind, pattern in KINDS if pattern.match(item)), None)


def positional_records(tree):
    """Braces with five or more bare values of which not all are elements of one array or row of a table: a name
    stands before the braces (`Type{…}`, `name{…}`, `return {…}`), or the kinds of values differ."""
    for name, _ in tree.select(CODE, CXX):
        text, found = tree.blank(name), []
        for opened in re.finditer(r"\{", text):
            inside_braces = text[opened.end():closing(text, opened.start())]
            if ";" in inside_braces:
                continue
            items = items_of(inside_braces)
            if any(re.match(r"\.[A-Za-z_]", item) for item in items):
                continue
            bare = [kind for kind in map(kind_of, items) if kind]
            if len(bare) < 5 or is_array(text, opened.start(), items, bare):
                continue
            found.append((opened.start(), "{" + " ".join(inside_braces.split())[:100] + "}"))
        if found:
            yield name, places(text, found)


def is_array(text, start, items, bare):
    """True if the braces list elements of one type: an array, a span, a vector, a row of a table of numbers, words."""
    if len(set(bare)) > 1:
        return False
    if bare[0] in ("text", "braces") and not re.search(r"\b[A-Z]\w*\s*$", text[max(0, start - 100):start]):
        return True
    before = text[max(0, start - 200):start]
    statement = re.split(r"[;{}]", before)[-1] if not before.rstrip().endswith(("{", ",", "}")) else ""
    if re.search(r"\[[^\]]*\]\s*=?\s*$|array|vector|span|initializer_list|\bauto\b[^;]*=\s*$|\bfor\s*\(|Vec\w*$", statement):
        return True
    if not statement.strip():  # nested: a row. It is a record if its items are no plain numbers of one kind.
        return len(bare) == len(items)
    return False


def is_type_declaration(group):
    return re.search(r"^\s*(?:template.*\n\s*)?(?:class|struct|union|enum class|enum|using|concept)\s+\w+", group, re.M)


PRIVATE = re.compile(r"^( *) (?:private|protected):\n.*?(?=^\1(?: public:|\};))", re.S | re.M)
NO_DECLARATION = re.compile(r"^\s*(?:(?:class|struct|enum class) [\w:]+(?: : [\w:]+)?;|namespace [\w:]+ \{.*|\}.*|friend .*= default;|"
                            r"[^(]*\(const \w+&\)(?: noexcept)? = (?:default|delete);|"
                            r"[^(]*\(\w+&&\)(?: noexcept)? = (?:default|delete);)$", re.M)
DECLARES = re.compile(r"^\s*[\w:<>,&*\[\] ]+[\s&*>]~?(?:operator\s*\S{1,3}|\w+)\([^;{]*\)[^;{()]*[;{]", re.M)


def public_headers(tree):
    for name, text in tree.files.items():
        if not re.match(r"(ecs|engine/\w+)/CMakeLists.txt$", name):
            continue
        match = re.search(r"^  HEADERS (.*?)(?=^  [A-Z_]+ |\))", text, re.S | re.M)
        for header in match[1].split() if match else []:
            path = f"{name.rsplit('/', 1)[0]}/{header}"
            if path in tree.files:
                yield path


def uncommented(tree):
    """Per header: groups (lines between empty ones) outside private sections that declare a function or a type
    and hold no comment, and the count of all such groups."""
    for name, text in tree.select(CODE, (".hpp",)):
        bare = PRIVATE.sub(lambda m: "\n" * m.group(0).count("\n"), text)
        found, total, at = [], 0, 0
        for group in re.split(r"(\n[ \t]*\n)", bare):
            declared = NO_DECLARATION.sub("", group)
            if (DECLARES.search(declared) or is_type_declaration(declared)) and not internal(bare, at):
                total += 1
                if "//" not in group:
                    first = re.sub(r"^\s*(?:(?:public|protected|Q_SIGNALS|public Q_SLOTS|signals):\s*|Q_OBJECT\s*)+", "", declared)
                    found.append((at + len(group) - len(group.lstrip()), first.strip().split("\n")[0][:100]))
            at += len(group)
        yield name, places(bare, found), total


def internal(text, at):
    """True inside a namespace detail, which is no promise."""
    opened = text.rfind("namespace detail", 0, at)
    return opened >= 0 and not re.search(r"^\}  // namespace detail", text[opened:at], re.M)


INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def headers_behind(tree, header):
    tree.need(header in tree.files, header)
    seen, front = set(), [header]
    while front:
        for name in INCLUDE.findall(tree.files.get(front.pop(), "")):
            if name in tree.files and name not in seen:
                seen.add(name)
                front.append(name)
    return sorted(seen - {header})


def rooms(tree, layer):
    """room -> rooms whose headers its files include. The folder's own files are two rooms: headers that its
    CMakeLists.txt lists under HEADERS, and the rest."""
    public = set(public_headers(tree))

    def room(path):
        inner = path[len(layer) + 1:].split("/")
        return inner[0] if len(inner) > 1 else "(public)" if path in public else "(private)"
    arrows = collections.defaultdict(set)
    tree.need(any(name.startswith(layer + "/") for name in tree.files), layer)
    for name, text in tree.select((layer.split("/")[0],), CXX):
        if name.startswith(layer + "/"):
            for target in INCLUDE.findall(text):
                if target.startswith(layer + "/") and room(target) != room(name):
                    arrows[room(name)].add(room(target))
    return arrows


def mutual_pairs(tree, layer="engine/scene"):
    arrows = rooms(tree, layer)
    return [f"{a} and {b}" for a in sorted(arrows) for b in sorted(arrows[a]) if a < b and a in arrows.get(b, ())]


def systems(tree):
    """name -> count of parameters of each NAME_system of engine/scene."""
    found = {}
    for name, _ in tree.select(("engine",), (".hpp", ".cpp")):
        if name.startswith("engine/scene/"):
            for _, function, parameters in tree.functions(name):
                if function.endswith("_system"):
                    found[function.rsplit("::", 1)[-1]] = len(parameters)
    return tree.need(found, "system in engine/scene")


# A new pass touches the files that name it. Particles stand for all passes, because nothing else shares their word.
PASS = re.compile(r"particle|emitter", re.I)


def files_of_a_pass(tree):
    return tree.need([name for name, text in tree.files.items()
                      if name.startswith(("engine/render/", "shaders/")) and PASS.search(text)], "file of a pass")


def subjects(tree):
    """stem -> (first file, lines). A header, its sources (one for each system) and its -inl.hpp are one subject."""
    found = collections.defaultdict(list)
    for name, text in tree.select(CODE, CXX):
        found[re.sub(r"(-inl|_posix|_windows)?\.\w+$", "", name)].append((name, text.count("\n")))
    return {stem: (files[0][0], sum(lines for _, lines in files)) for stem, files in found.items()}


TEST_NAME = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*\w+,\s*(\w+)", re.M)


def is_sentence(name):
    """True for an UpperCamel name of two or more words."""
    return re.fullmatch(r"[A-Z][A-Za-z0-9]*", name) and len(re.findall(r"[A-Z]+(?![a-z])|[A-Z][a-z]+|\d+", name)) > 1


def odd_test_names(tree):
    for name, text in tree.select(("tests",), (".cpp", ".hpp")):
        found = [(m.start(), m[1]) for m in TEST_NAME.finditer(text) if not is_sentence(m[1])]
        yield name, places(text, found), len(TEST_NAME.findall(text))


MOST = re.compile(r"\b(?:k(?:Most|Least)[A-Z]\w*|(?:most|least)_(?!recently|significant)\w+)\b")


STATE = re.compile(r"\bstate(?:\(\))?\.(?:facts|entities|assets|simulation|meshes|counters|totals)\b")  # private to the scene


def renamed_names(tree):
    """Old names of the table of the changelog (| `old` | `new` | …), and those without their scope that are unique."""
    text = tree.files.get("CHANGELOG.md", "")
    table = re.search(r"^## Names.*?(?=^## |\Z)", text, re.S | re.M)
    old, new = set(), set()
    for row in re.findall(r"^\|([^|]*)\|([^|]*)\|", table[0], re.M) if table else []:
        for names, cell in ((old, row[0]), (new, row[1])):
            names.update(name.removesuffix("()") for name in re.findall(r"`([^`]+)`", cell))
    old |= {last for last in map(last_part, old) if is_unique(last)}
    return tree.need(old - {last_part(name.split("(")[0]) for name in new}, "table of names")


def last_part(name):
    return name.rsplit("::", 1)[-1]


def is_unique(name):
    """True for an identifier of two or more words, or a long word: nothing else is likely to have it."""
    return re.fullmatch(r"\w+", name) and (len(re.findall(r"[A-Z]?[a-z]+", name.removeprefix("k"))) > 1 or len(name) > 9)


def code_of_page(text):
    """A page with all but code spans and blocks made empty."""
    return "".join(piece if k % 2 else re.sub(r"[^\n]", " ", piece) for k, piece in
                   enumerate(re.split(r"(^```.*?^```|`[^`\n]+`)", text, flags=re.S | re.M)))


extra_names = set()  # of --names


def old_names(tree, names):
    """Uses of names that have a successor, and of names with most and least instead of max and min."""
    names = sorted(n for n in names if re.fullmatch(r"\w+(?:::\w+)+", n) or is_unique(n) or n in extra_names)
    old = re.compile(r"(?<!\w)(?:" + "|".join(map(re.escape, names)) + r")\b") if names else None
    sources = [(name, tree.blank(name)) for name, _ in tree.select((*CODE, "tests", "examples", "shaders"), CXX + SHADERS)]
    pages = [(name, code_of_page(text)) for name, text in tree.files.items() if name.endswith(".md") and name != "CHANGELOG.md"]
    for name, blank in sources + pages:
        found = [(m.start(), m[0]) for m in MOST.finditer(blank)]
        found += [(m.start(), m[0]) for m in old.finditer(blank)] if old else []
        found += [(m.start(), m[0]) for m in STATE.finditer(blank)] if name.endswith(".md") else []
        yield name, places(blank, sorted(found))


# ---------------------------------------------------------------- figures

class Figure:
    """A number, the places that it counts by file, and by how much each file weighs in a rate."""

    def __init__(self, value, found=None, note=""):
        self.value, self.found, self.note = value, found or {}, note


def per_thousand(tree):
    rows = list(noun_clauses(tree))
    found = {name: at for name, at, _ in rows if at}
    words = tree.need(sum(words for *_, words in rows), "word")
    return Figure(1000 * sum(map(len, found.values())) / max(words, 1), found, f"{words} words")


def comments_percent(tree):
    rows = list(uncommented(tree))
    missing, total = sum(len(at) for _, at, _ in rows), tree.need(sum(n for *_, n in rows), "declaration")
    return Figure(100 * missing / max(total, 1), {n: at for n, at, _ in rows if at}, f"{missing} of {total} groups")


def long_percent(tree):
    found, total = long_sentences(tree, "docs/architecture.md")
    return Figure(100 * len(found) / max(total, 1), {"docs/architecture.md": found}, f"{len(found)} of {total}")


def count(function):
    def figure(tree):
        found = dict(function(tree))
        return Figure(sum(map(len, found.values())), found)
    return figure


def bools_of_render(tree):
    found = {n: at for n, at in neighbouring_bools(tree).items() if n.startswith("engine/render/")}
    return Figure(sum(map(len, found.values())), found)


def pairs(tree):
    found = mutual_pairs(tree)
    return Figure(len(found), {"engine/scene": [(0, pair) for pair in found]})


def behind_scene(tree):
    found = headers_behind(tree, "engine/scene/scene.hpp")
    return Figure(len(found), {"engine/scene/scene.hpp": [(0, name) for name in found]})


def systems_sum(tree):
    found = systems(tree)
    return Figure(sum(found.values()), {"engine/scene": [(0, f"{n} {p}") for n, p in found.items()]}, f"{len(found)} systems")


def systems_max(tree):
    found = systems(tree)
    return Figure(max(found.values(), default=0), {"engine/scene": [(0, f"{n} {p}") for n, p in found.items() if p > 7]})


def pass_files(tree):
    found = files_of_a_pass(tree)
    return Figure(len(found), {name: [(0, "names particles")] for name in found})


def fragments(tree):
    found = subjects(tree)
    small = {first: [(0, f"{lines} lines")] for first, lines in found.values() if lines < 40}
    return Figure(100 * len(small) / max(len(found), 1), small, f"{len(small)} of {len(found)}")


def lines(tree):
    found = collections.Counter()
    for name, text in tree.select(CODE, CXX):
        found[name.split("/")[0]] += text.count("\n")
    return Figure(sum(found.values()), {}, ", ".join(f"{k} {v}" for k, v in found.items()))


def test_names(tree):
    rows = list(odd_test_names(tree))
    return Figure(sum(len(at) for _, at, _ in rows), {n: at for n, at, _ in rows if at}, f"of {sum(n for *_, n in rows)}")


def page_lines(tree):
    sources = [(name, text.count("\n")) for name, text in tree.files.items()
               if name.endswith(PAGES) and name.split("/")[0] in CODE]
    tree.need(sources, "source of a page")
    return Figure(sum(n for _, n in sources), {name: [(0, f"{n} lines")] for name, n in sources})


def names_left(tree):
    found = {n: at for n, at in old_names(tree, renamed_names(tree) | extra_names) if at}
    return Figure(sum(map(len, found.values())), found)


# figure, limit that holds today (lower it when a figure falls), target, how it is counted, its rule
MEASURES = [
    ("noun-clauses", 0.2, 0.2, per_thousand, "sentences that open with a noun clause, per 1,000 words of comments, docs and messages"),
    ("uncommented", 1.0, 1.0, comments_percent, "% of groups of public declarations, in all headers, without a comment"),
    ("long-sentences", 5.0, 5.0, long_percent, "% of sentences over 25 words in docs/architecture.md"),
    ("parameters", 0, 0, count(long_parameter_lists), "functions with more than 7 parameters, outside kernels"),
    ("bools", 0, 0, count(neighbouring_bools), "functions with two neighbouring bools"),
    ("bools-render", 0, 0, bools_of_render, "functions of engine/render with two neighbouring bools"),
    # The rows left stand in tables under a line that names the columns (fields of world files and of species).
    ("records", 0, 0, count(positional_records), "positional records of five or more literals; nested braces of literals are one"),
    ("mutual-rooms", 0, 0, pairs, "mutual pairs of rooms in engine/scene"),
    ("scene-headers", 10, 10, behind_scene, "project headers behind engine/scene/scene.hpp"),
    ("systems-sum", 80, 80, systems_sum, "parameters of all systems"),
    ("systems-max", 7, 7, systems_max, "most parameters of a system"),
    ("pass-files", 7, 7, pass_files, "files of engine/render and shaders that name particles, build lists included"),
    ("fragments", 3.0, 3.0, fragments, "% of subjects (a header with its source) under 40 lines"),
    ("lines", 141740, 109000, lines, "lines of C++ in ecs, engine, editor and game"),
    ("page-lines", 709, 709, page_lines, "lines of JavaScript and CSS in ecs, engine, editor and game, which \"lines\" leaves out"),
    ("test-names", 0, 0, test_names, "names of tests that are no sentence in UpperCamel"),
    ("old-names", 0, 0, names_left, "old names of the changelog's table in code, and names with most or least for max or min"),
]


def shown(value):
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def folder_of(name):
    parts = name.split("/")
    return "/".join(parts[:2]) if parts[0] in ("engine", "editor", "tests") and len(parts) > 2 else parts[0]


def inside(tree, folder):
    if not folder:
        return tree
    keep = {n: t for n, t in tree.files.items() if n == folder or n.startswith(folder.rstrip("/") + "/")}
    return Tree(keep)


def report(tree, by_folder, worst=5):
    print(f"{'figure':15} {'value':>8} {'limit':>8} {'target':>8}  rule")
    for name, limit, target, measure, rule in MEASURES:
        figure = measure(tree)
        note = f" ({figure.note})" if figure.note else ""
        print(f"{name:15} {shown(figure.value):>8} {shown(limit):>8} {shown(target):>8}  {rule}{note}")
        counts = collections.Counter()
        for file, at in figure.found.items():
            counts[folder_of(file) if by_folder else file] += len(at)
        for file, number in sorted(counts.items(), key=lambda item: -item[1])[:60 if by_folder else worst]:
            print(f"{'':15} {number:8}   {file}")


def list_places(tree, wanted):
    for name, _, _, measure, _ in MEASURES:
        if name == wanted:
            for file, at in measure(tree).found.items():
                for line, what in at:
                    print(f"{file}:{line}: {what}" if line else f"{file}: {what}")
            return 0
    print("figures: " + ", ".join(name for name, *_ in MEASURES))
    return 2


def hold(tree):
    beyond = 0
    for name, limit, target, measure, rule in MEASURES:
        tree.missing.clear()
        figure = measure(tree)
        if tree.missing:
            beyond += 1
            print(f"{name}: the scan found no {', no '.join(dict.fromkeys(tree.missing))}: {rule}")
        elif figure.value > limit:
            beyond += 1
            print(f"{name}: {shown(figure.value)}, and the limit is {shown(limit)}: {rule}")
            for file, at in list(figure.found.items())[:20]:
                for line, what in at[:5]:
                    print(f"  {file}:{line}: {what}")
        elif limit > target and figure.value <= target:
            print(f"{name}: {shown(figure.value)} has reached its target; set its limit to {shown(target)}")
    if not beyond:
        print("style: every figure is within its limit")
    return 1 if beyond else 0


# ---------------------------------------------------------------- self-test

def self_test():
    for text in ("What is predicted may go.", "Whether a frame waits.", "How much memory is free.", "Where it stands.",
                 "Nobody reads it.", "Whatever comes is taken.", "Whose share a block is."):
        assert opens_with_a_noun_clause(text), text
    for text in ("What is a node?", "How to add a pass", "Where memory is shared, nothing is copied.", "True if …",
                 "The node that covers it.", "Whole regions.", "However, no."):
        assert not opens_with_a_noun_clause(text), text
    assert len(list(sentences("One ends. Two, e.g. Three, ends (here). Four!"))) == 3
    source = '// What it is.\n// Second line.\nint a;  // behind\nf("two words", "three words " "of text");\n'
    assert [body for _, body in prose_of_cxx(source)] == ["What it is.\nSecond line.", "behind", "three words of text"]
    page = "# A\nText goes\non.\n\n- an item\n- another\n\n| a cell | 12 |\n```sh\nWhat not\n```\n"
    assert [body for _, body in prose_of_markdown(page)] == ["A", "Text goes on.", "an item", "another", "a cell"]

    tree = Tree({"engine/scene/a.cpp": '''
namespace psygen { namespace {
constexpr int kTable[] = {1, 2, 3, 4, 5};
struct Options { bool a = f(1, 2); void set(bool near, bool far); int get() const { return 1; } };
void eight(int a, int b, int c, int d, std::map<int, int> e, int f, int g, int h = 3) { call(1, 2, 3); }
A::A(int x) : a_{x}, b_(2) { if (x) { run(); } }
}
[[nodiscard]] std::expected<int, Error> load_system(const Query<A, B>& q, int& b);
const Preset kHigh{true, true, false, 4, 2, 2048};
auto p = Preset{.a = 1, .b = 2, .c = 3, .d = 4, .e = 5};
}''', "tests/engine/a.cpp": "TEST(A, IsSentence) {}\nTEST(A, is_snake) {}\nTEST(A, Word) {}\n",
        "engine/scene/CMakeLists.txt": "psygen_library(scene\n  HEADERS b.hpp\n  PRIVATE x)\n",
        "engine/scene/b.hpp": '#include "engine/scene/c/d.hpp"\n\n// Of f.\nint f(int a);\n\nint g();\n\n'
                              "class C {\n private:\n  int h();\n};\n",
        "engine/scene/c/d.hpp": '#include "engine/scene/b.hpp"\n',
        "CHANGELOG.md": "## Names\n\n| old | new |\n| --- | --- |\n| `a::kOld`, `World::land` | `a::kNew` |\n"
                        "| `a::keep_room`, `b::tick_all(State&)`, `c::ask_on()` | `keep`, `tick_all`, `d::ask_on()` |\n",
        "engine/a/k.cpp": "int a(int, int, int, int, int, int, int, int);\nnamespace b::HWY_NAMESPACE {\n"
                              "int c(V, V, V, V, V, V, V, V) { return {}; }\n}\nint d(int, int, int, int, int, int, int, int);\n",
        "game/x.cpp": "int b = a::kOld = k" "MostThings;\nkeep_room(); tick_all(); ask_on(); land();\n"})
    names = {f: p for _, f, p in tree.functions("engine/scene/a.cpp")}
    assert len(names["eight"]) == 8 and len(names["load_system"]) == 2 and names["get"] == [], names
    assert names["set"] == ["bool near", "bool far"] and "A::A" in names and "call" not in names, names
    assert count(long_parameter_lists)(tree).value == 3, dict(long_parameter_lists(tree))
    assert count(neighbouring_bools)(tree).value == 1
    assert count(positional_records)(tree).value == 1, dict(positional_records(tree))
    assert test_names(tree).value == 2 and mutual_pairs(tree) == ["(public) and c"]
    assert systems(tree) == {"load_system": 2} and behind_scene(Tree({
        "engine/scene/scene.hpp": '#include "a.hpp"\n', "a.hpp": '#include "b.hpp"\n', "b.hpp": ""})).value == 2
    assert list(uncommented(tree))[0][1:] == ([(6, "int g();"), (8, "class C {")], 3), list(uncommented(tree))
    records = 'A a{"x", 1, true, {0, 1}, f(2), \'c\'}; std::string_view b[] = {"a", "b", "c", "d", "e"};' \
              "Byte c[] = {1, 'a', 2, 'b', 3}; auto d = g({1, 2, 3, 4, x}, {.a = 1, .b = 2, .c = 3, .d = 4, .e = 5});"
    assert count(positional_records)(Tree({"game/a.cpp": records})).value == 1, dict(positional_records(Tree({"game/a.cpp": records})))
    assert names_left(tree).value == 3, names_left(tree).found
    empty = Tree({})
    for name, _, _, measure, _ in MEASURES:
        empty.missing.clear()
        measure(empty)
        assert empty.missing, f"{name} passes on an empty tree"
    assert fragments(tree).value > 99
    print("style: the rules notice what they are for")


def main():
    arguments = sys.argv[1:]
    if arguments == ["--self-test"]:
        return self_test()
    if "--names" in arguments:
        k = arguments.index("--names")
        extra_names.update(pathlib.Path(arguments[k + 1]).read_text(encoding="utf-8").split())
        del arguments[k:k + 2]
    by_folder = "--by-folder" in arguments
    arguments = [a for a in arguments if a != "--by-folder"]
    mode, wanted = "hold", None
    if arguments[0] == "--report":
        mode, arguments = "report", arguments[1:]
    elif arguments[0] == "--list":
        mode, wanted, arguments = "list", arguments[1], arguments[2:]
    tree = Tree.read(pathlib.Path(arguments[0]))
    assert len(tree.files) > 100, "the scan found too few files to mean anything"
    tree = inside(tree, arguments[1] if len(arguments) > 1 else "")
    if mode == "list":
        return list_places(tree, wanted)
    return hold(tree) if mode == "hold" else report(tree, by_folder)


if __name__ == "__main__":
    sys.exit(main())
