"""Pretty printers of gdb for psygen's types: entities, rows of queries, results, positions, mesh keys, and spans if
libstdc++ brings no printer of its own.

    gdb -iex "source tools/gdb/psygen.py" --args build/dev/bin/psygen fly …

An installed package has the file as share/psygen/gdb/psygen.py. A line `source PATH` in ~/.gdbinit loads it always.
"""
import gdb
import gdb.printing


def number(value):
    return int(value)


def plain(kind):
    """A type without typedefs and const."""
    return kind.strip_typedefs().unqualified()


def short_name(kind):
    return str(plain(kind)).split("<")[0].split("::")[-1]


def text_of(string):
    """The characters of a std::string, also without the printers of libstdc++."""
    characters = string["_M_dataplus"]["_M_p"]
    return characters.string("utf-8", "replace", number(string["_M_string_length"]))


class Children:
    """Elements of an array in memory, as gdb shows arrays."""

    def __init__(self, first, count):
        self.first, self.count = first, count

    def __iter__(self):
        for i in range(self.count):
            yield f"[{i}]", (self.first + i).dereference()


class EntityPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        index, generation = number(self.value["index"]), number(self.value["generation"])
        if index == 0xFFFFFFFF and generation == 0:
            return "null entity"
        return f"entity {index} (generation {generation})"


class TableRowsPrinter:
    """The rows that a query visits: its components, and the entity of each row."""

    def __init__(self, value):
        self.value = value

    def entities(self):
        memory = self.value["table_"].dereference()["entities_"]["data_"]
        kind = gdb.lookup_type("psygen::ecs::Entity").pointer()
        return memory.reinterpret_cast(kind) + number(self.value["first_"])

    def to_string(self):
        components = []
        while True:
            try:
                components.append(short_name(self.value.type.strip_typedefs().template_argument(len(components))))
            except (RuntimeError, gdb.error):
                break
        first, count = number(self.value["first_"]), number(self.value["count_"])
        table = number(self.value["table_"].dereference()["id_"])
        return f"{count} rows from {first} of table {table} with {', '.join(components)}"

    def children(self):
        return Children(self.entities(), number(self.value["count_"]))

    def display_hint(self):
        return "array"


class RowPlacePrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        return f"row {number(self.value['row'])} of table {number(self.value['table'])}"


class BlockPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        return f"block ({number(self.value['x'])}, {number(self.value['z'])})"


class PositionPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        local = self.value["local"]
        metres = ", ".join(f"{float(local[axis]):g}" for axis in "xyz")
        return f"{BlockPrinter(self.value['block']).to_string()} + ({metres}) m"


class MeshKeyPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        v = self.value
        again = " (duplicate)" if bool(v["spare"]) else ""
        return (f"{BlockPrinter(v['block']).to_string()}, index {number(v['index'])}, type {number(v['model'])}, "
                f"LOD {number(v['level'])}, parameters {number(v['parameters_hash']):#018x}{again}")


class ErrorPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        code = str(self.value["code"]).split("::")[-1]
        return f"{code}: {text_of(self.value['message'])}"


class ResultPrinter:
    """core::Result<T>: the value, or the code and the message of the error."""

    def __init__(self, value):
        self.value = value

    def to_string(self):
        if bool(self.value["m_has_val"]):
            return "result" if self.holds_value() else "result without a value"
        error = self.value["m_unexpect"]["m_val"]
        if short_name(error.type) == "Error":
            return "error " + ErrorPrinter(error).to_string()
        return f"error {error}"

    def holds_value(self):
        return self.value.type.strip_typedefs().template_argument(0).code != gdb.TYPE_CODE_VOID

    def children(self):
        if bool(self.value["m_has_val"]) and self.holds_value():
            yield "value", self.value["m_val"]


class SpanPrinter:
    """Only where libstdc++ brings none: gdb asks the printers of a library first."""

    def __init__(self, value):
        self.value = value

    def count(self):
        extent = self.value["_M_extent"]
        try:
            return number(extent["_M_extent_value"])
        except (gdb.error, TypeError):  # a fixed extent is a template argument
            return number(self.value.type.strip_typedefs().template_argument(1))

    def to_string(self):
        return f"span of {self.count()}"

    def children(self):
        return Children(self.value["_M_ptr"], self.count())

    def display_hint(self):
        return "array"


def printers():
    found = gdb.printing.RegexpCollectionPrettyPrinter("psygen")
    for name, pattern, printer in (
            ("entity", r"^psygen::ecs::Entity$", EntityPrinter),
            ("query_rows", r"^psygen::ecs::TableRows<.*>$", TableRowsPrinter),
            ("row_place", r"^psygen::ecs::(detail::)?RowPlace$", RowPlacePrinter),
            ("block", r"^psygen::core::BlockCoord$", BlockPrinter),
            ("position", r"^psygen::core::WorldPosition$", PositionPrinter),
            ("mesh_key", r"^psygen::synthesis::MeshKey$", MeshKeyPrinter),
            ("error", r"^psygen::core::Error$", ErrorPrinter),
            ("result", r"^tl::expected<.*>$", ResultPrinter),
            ("span", r"^std::span<.*>$", SpanPrinter)):
        found.add_printer(name, pattern, printer)
    return found


gdb.printing.register_pretty_printer(None, printers(), replace=True)
