"""A JSON document and its schema -> the faults, by the keywords that dqpaint's schemas use.

A keyword that is not known here is an error, so that nothing is passed over.
"""

NUMBER = (int, float)
TYPES = {
    "object": dict, "array": list, "string": str, "boolean": bool, "null": type(None),
    "integer": int, "number": NUMBER,
}  # fmt: skip
ANNOTATIONS = {"title", "description", "default", "$schema", "$defs"}


def faults(value, schema, root=None, where="$"):
    """The faults of a value, one sentence each."""
    root = root or schema
    if schema is True:
        return
    if "$ref" in schema:
        node = root
        for part in schema["$ref"].removeprefix("#/").split("/"):
            node = node[part]
        yield from faults(value, node, root, where)
    if "anyOf" in schema and all(list(faults(value, s, root, where)) for s in schema["anyOf"]):
        yield f"{where}: {value!r} is none of those allowed"
    for word, told in schema.items():
        if word in ANNOTATIONS or word in ("$ref", "anyOf"):
            continue
        kind, check = CHECKS[word]
        if isinstance(value, kind):  # a keyword says nothing of other types
            yield from check(value, told, schema, root, where)


def _type(value, told, _schema, _root, where):
    right = isinstance(value, TYPES[told]) and not (told in ("integer", "number")
                                                    and isinstance(value, bool))  # fmt: skip
    if not right:
        yield f"{where}: {value!r} is no {told}"


def _properties(value, told, _schema, root, where):
    for name in told.keys() & value.keys():
        yield from faults(value[name], told[name], root, f"{where}.{name}")


def _required(value, told, _schema, _root, where):
    yield from (f"{where}: no {name}" for name in told if name not in value)


def _additional(value, told, schema, root, where):
    for name in value.keys() - schema.get("properties", {}).keys():
        if told is False:
            yield f"{where}: {name} is not known"
        else:
            yield from faults(value[name], told, root, f"{where}.{name}")


def _items(value, told, _schema, root, where):
    for i, one in enumerate(value):
        yield from faults(one, told, root, f"{where}[{i}]")


def _holds(test):
    def check(value, told, _schema, _root, where):
        if not test(value, told):
            yield f"{where}: {value!r} is not as {told!r} says"

    return check


CHECKS = {
    "type": (object, _type), "properties": (dict, _properties), "required": (dict, _required),
    "additionalProperties": (dict, _additional), "items": (list, _items),
    "const": (object, _holds(lambda v, t: v == t)), "enum": (object, _holds(lambda v, t: v in t)),
    "minItems": (list, _holds(lambda v, t: len(v) >= t)),
    "maxItems": (list, _holds(lambda v, t: len(v) <= t)),
    "minimum": (NUMBER, _holds(lambda v, t: v >= t)),
    "maximum": (NUMBER, _holds(lambda v, t: v <= t)),
    "exclusiveMinimum": (NUMBER, _holds(lambda v, t: v > t)),
}  # fmt: skip
