"""Laws written in Python as candidates of a diagnosis.

A function of q, v (and, for a dry friction, load) and its parameters is called once with symbols
and becomes a formula, which the tools and the extended model evaluate without Python:

    def drag(q, v, b):
        return b * v * abs(v)

    experiment["candidates"] = ["all", force_law(drag, b={"initial": 0.01, "lower": 0, "upper": 1,
                                                          "absent": 0, "unit": "N*m*s^2/rad^2"})]

The function may use arithmetic, other functions, loops of a known length and numpy's functions of
numbers; a choice that depends on q, v, load or a parameter is numpy.where(condition, a, b) instead
of `if`. It has no memory.
"""
import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any


def force_law(function: Callable[..., Any], where: str = "",
              **parameters: Mapping[str, Any]) -> dict[str, Any]:
    """A candidate: a force on a joint [N*m] or tendon [N] that depends on q and v.

    At a joint it may also depend on motor and weight, the torques of the actuators and of gravity, on
    time and on heat, z of heat_time z' = motor^2 - z, where heat_time is one of the parameters [s].
    force times v is power into the effect: b*v with b > 0 brakes. where: "joint:GLOB" or
    "tendon:GLOB"; empty: all joints. Each parameter of the function has initial, lower, upper, absent
    (the value at which the law does nothing; not for those that only say how it acts) and unit."""
    return _law(function, where, parameters, "formula", "force",
                ("q", "v", "motor", "weight", "time", "heat"))


def friction_law(function: Callable[..., Any], where: str = "",
                 **parameters: Mapping[str, Any]) -> dict[str, Any]:
    """A candidate: a dry friction whose level depends on q, v and load, the load on the gear [N*m].

    The function gives the level >= 0 at which it slides; at rest it holds. Else as force_law."""
    return _law(function, where, parameters, "formula_friction", "level", ("q", "v", "load"))


def _law(function, where, parameters, effect, key, variables):
    if not function.__name__.isidentifier():
        raise TypeError(f"a law has the name of its function, and {function.__name__} is none: "
                        "write it with def")
    names = list(inspect.signature(function).parameters)
    wanted = [name for name in names if name not in variables]
    if set(wanted) != set(parameters):
        raise TypeError(f"{function.__name__} has the parameters {', '.join(wanted) or 'none'}; "
                        f"given: {', '.join(parameters) or 'none'}")
    law = {"effect": effect, "name": function.__name__, key: _traced(function, names),
           "parameters": [{"name": name, **parameters[name]} for name in wanted]}
    return law | ({"where": where} if where else {})


def _traced(function, names):
    """The formula of a function, whose errors name the law."""
    try:
        answer = function(**{name: Symbol(name) for name in names})
        if answer is None:
            raise TypeError("it returns nothing: is there no return?")
        if isinstance(answer, (list, tuple, dict, str)) or getattr(answer, "shape", ()):
            raise TypeError(f"it returns {answer!r} instead of one number")
        return _formula(_symbol(answer))
    except (AttributeError, TypeError, ValueError) as error:
        kind = ValueError if isinstance(error, ValueError) else TypeError
        raise kind(f"the law {function.__name__}: {error}") from error


class Symbol:
    """A number that is not known yet: the operator and operands that give it."""

    __slots__ = ("operator", "operands")
    __hash__ = object.__hash__

    def __init__(self, operator: str, *operands: "Symbol"):
        self.operator, self.operands = operator, operands

    def __repr__(self): return _formula(self)

    def __add__(self, other): return Symbol("+", self, _symbol(other))
    def __radd__(self, other): return Symbol("+", _symbol(other), self)
    def __sub__(self, other): return Symbol("-", self, _symbol(other))
    def __rsub__(self, other): return Symbol("-", _symbol(other), self)
    def __mul__(self, other): return Symbol("*", self, _symbol(other))
    def __rmul__(self, other): return Symbol("*", _symbol(other), self)
    def __truediv__(self, other): return Symbol("/", self, _symbol(other))
    def __rtruediv__(self, other): return Symbol("/", _symbol(other), self)
    def __pow__(self, other): return Symbol("^", self, _symbol(other))
    def __rpow__(self, other): return Symbol("^", _symbol(other), self)
    def __neg__(self): return Symbol("negative", self)
    def __pos__(self): return self
    def __abs__(self): return Symbol("abs", self)
    def __gt__(self, other): return Condition(self - other, False)
    def __lt__(self, other): return Condition(other - self, False)
    def __ge__(self, other): return Condition(other - self, True)
    def __le__(self, other): return Condition(self - other, True)

    def __eq__(self, other):
        raise TypeError("a law cannot ask whether numbers are equal: use <, <=, > or >=")

    def __bool__(self):
        raise TypeError(f"a law cannot branch on {_formula(self)}: use numpy.where(c, a, b)")

    def __float__(self):
        raise TypeError(f"{_formula(self)} has no value yet: use numpy's functions instead of "
                        "math's")

    __int__ = __index__ = __float__

    def _refuse(self, *_):
        raise TypeError("a law cannot use %, //, @, divmod or round: it can use + - * / ** abs, "
                        "comparisons in numpy.where, and numpy's functions of numbers")

    __mod__ = __rmod__ = __floordiv__ = __rfloordiv__ = __matmul__ = __rmatmul__ = _refuse
    __divmod__ = __rdivmod__ = __round__ = __floor__ = __ceil__ = __trunc__ = _refuse

    def __array_ufunc__(self, ufunc, method, *inputs, **options):
        known = _UFUNCS.get(ufunc.__name__)
        if known is None or method != "__call__" or options:
            raise TypeError(f"a law cannot use numpy.{ufunc.__name__}; it can use "
                            f"{', '.join(sorted(_UFUNCS))}, where, clip")
        return known(*(_symbol(value) for value in inputs))

    def __array_function__(self, function, types, arguments, options):
        known = {"where": _where, "clip": _clip}.get(function.__name__)
        if known is None:
            raise TypeError(f"a law cannot use numpy.{function.__name__}")
        return known(*arguments, **options)


class Condition:
    """Whether a number is above zero; flipped: whether it is not."""

    def __init__(self, number: Symbol, flipped: bool):
        self.number, self.flipped = number, flipped

    def __invert__(self): return Condition(self.number, not self.flipped)

    def __bool__(self):
        raise TypeError("a law cannot branch on a condition of its arguments: use "
                        "numpy.where(condition, a, b)")

    __array_function__ = Symbol.__array_function__


def _where(condition, a, b):
    if not isinstance(condition, Condition):
        raise TypeError("numpy.where in a law needs a comparison, such as v > 0")
    if condition.flipped:
        a, b = b, a
    return Symbol("where", condition.number, _symbol(a), _symbol(b))


def _clip(number, lower, upper):
    return Symbol("min", Symbol("max", _symbol(number), _symbol(lower)), _symbol(upper))


def _function(name):
    return lambda *operands: Symbol(name, *operands)


_UFUNCS = {name: _function(name)
           for name in ("sign", "sqrt", "exp", "log", "sin", "cos", "tan", "tanh")}
_UFUNCS |= {"absolute": abs, "fabs": abs, "arctan": _function("atan"),
            "arctan2": _function("atan2"), "minimum": _function("min"),
            "maximum": _function("max"), "square": lambda x: x * x, "negative": lambda x: -x,
            "add": lambda x, y: x + y, "subtract": lambda x, y: x - y,
            "multiply": lambda x, y: x * y, "divide": lambda x, y: x / y,
            "power": lambda x, y: x ** y, "float_power": lambda x, y: x ** y,
            "greater": lambda x, y: x > y, "greater_equal": lambda x, y: x >= y,
            "less": lambda x, y: x < y, "less_equal": lambda x, y: x <= y}


def _symbol(value: Any) -> Symbol:
    """A symbol as it is, a number as a symbol."""
    if isinstance(value, Symbol):
        return value
    if isinstance(value, Condition):
        return _where(value, 1, 0)
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"a law cannot use the number {number}")
    return Symbol("negative", Symbol(repr(-number))) if number < 0 else Symbol(repr(number))


# How tightly an operator holds its operands, and how tightly the left and the right one must hold
# together to stand without parentheses.
_BINDING = {"+": (1, 1, 2), "-": (1, 1, 2), "*": (2, 2, 3), "/": (2, 2, 3), "^": (4, 5, 3)}


def _formula(root: Symbol) -> str:
    """The text of a symbol; what is used more than once gets a name."""
    uses, order = {}, []

    def count(symbol):
        uses[symbol] = uses.get(symbol, 0) + 1
        if uses[symbol] == 1:
            for operand in symbol.operands:
                count(operand)
            order.append(symbol)

    count(root)
    names, parts = {}, []

    def text(symbol, least=0):
        if symbol in names:
            return names[symbol]
        operator, operands = symbol.operator, symbol.operands
        if not operands:
            return operator
        if operator in _BINDING:
            binding, left, right = _BINDING[operator]
            written = f"{text(operands[0], left)}{operator}{text(operands[1], right)}"
        elif operator == "negative":
            binding, written = 3, "-" + text(operands[0], 4)
        else:
            return f"{operator}({', '.join(text(operand) for operand in operands)})"
        return written if binding >= least else f"({written})"

    for symbol in order:
        if uses[symbol] > 1 and symbol.operands:
            part = text(symbol)
            names[symbol] = f"_{len(parts) + 1}"
            parts.append(f"{names[symbol]} = {part}; ")
    return "".join(parts) + text(root)
