"""Eight numbers at once in a compiled loop: sums over a node's neighbours that stay in registers.

A compiler vectorises the innermost loop. Over right-hand sides that loop is short and its sums go
through memory at each neighbour; over neighbours it has numbers far apart. What would put the two
together, LLVM's vectorisation of straight code, numba has switched off since it miscompiled
(numba/numba, pull request 8852). So loops say here what they mean: a vector of as many columns, of
which LLVM makes registers of whatever width the processor has.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, models, register_model

# its stubs take the first argument for one that a loop gives
_in_loops: Callable[[Any], Any] = intrinsic

LANES = 8
"""Numbers in a vector."""

_NUMBER, _PLACE = ir.DoubleType(), ir.IntType(32)
_LANES, _SINGLE = ir.VectorType(_NUMBER, LANES), ir.VectorType(ir.FloatType(), LANES)


class Vector(types.Type):  # type: ignore[misc]
    """Type of such a vector in a compiled loop."""

    def __init__(self) -> None:
        super().__init__(name=f"{LANES} numbers")


_VECTOR = Vector()


@register_model(Vector)
class _Registers(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Vector) -> None:
        super().__init__(manager, kind, _LANES)  # type: ignore[no-untyped-call]


def _address(context: Any, builder: Any, kind: Any, array: Any, index: Any, vector: Any) -> Any:
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), vector.as_pointer())


def _spread(builder: Any, kind: Any, number: Any) -> Any:
    """The same number in all lanes."""
    if kind.bitwidth == 32:
        number = builder.fpext(number, _NUMBER)
    nothing = ir.Constant(_LANES, ir.Undefined)
    first = builder.insert_element(nothing, number, ir.Constant(_PLACE, 0))
    return builder.shuffle_vector(
        first, nothing, ir.Constant(ir.VectorType(_PLACE, LANES), [0] * LANES)
    )


@_in_loops
def load(typing: Any, array: Any, index: Any) -> Any:
    """The numbers of a flat array from an index on, in double precision."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        kind, (array, index) = signature.args[0], given
        if kind.dtype.bitwidth == 64:
            return builder.load(_address(context, builder, kind, array, index, _LANES), align=8)
        address = _address(context, builder, kind, array, index, _SINGLE)
        return builder.fpext(builder.load(address, align=4), _LANES)

    return _VECTOR(array, index), generate


@_in_loops
def store(typing: Any, vector: Any, array: Any, index: Any) -> Any:
    """Put a vector into a flat array from an index on."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        vector, array, index = given
        address = _address(context, builder, signature.args[1], array, index, _LANES)
        builder.store(vector, address, align=8)
        return context.get_dummy_value()

    return types.void(vector, array, index), generate


@_in_loops
def times(typing: Any, number: Any, vector: Any) -> Any:
    """The product of a number and a vector."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        number, vector = given
        return builder.fmul(_spread(builder, signature.args[0], number), vector)

    return _VECTOR(number, vector), generate


@_in_loops
def plus(typing: Any, vector: Any, number: Any, other: Any) -> Any:
    """The sum of a vector and the product of a number and another one, rounded once or twice."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        vector, number, other = given
        product = builder.fmul(
            _spread(builder, signature.args[1], number), other, flags=("contract",)
        )
        return builder.fadd(vector, product, flags=("contract",))

    return _VECTOR(vector, number, other), generate


@_in_loops
def less_block(
    typing: Any, f: Any, g: Any, h: Any, blocks: Any, place: Any, array: Any, index: Any, row: Any
) -> Any:
    """Three vectors less a 3x3 block times three rows of an array, each entry as `plus` adds it.

    One statement: as one for each entry, loops would take twice as long to compile.

    Parameters
    ----------
    f, g, h : Vector
        The vectors.
    blocks, place : array, uint64
        Flat, and where in it the block begins.
    array, index, row : array, uint64, uint64
        Flat, where in it the first of the rows begins, and how many numbers a row has.
    """
    sums = types.UniTuple(_VECTOR, 3)  # type: ignore[no-untyped-call]

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        *found, blocks, place, array, index, row = given
        kind, of_rows = signature.args[3], signature.args[5]
        data = context.make_array(kind)(context, builder, blocks).data
        others = []
        for _ in range(3):
            address = _address(context, builder, of_rows, array, index, _LANES)
            others.append(builder.load(address, align=8))
            index = builder.add(index, row)
        for entry in range(9):
            k = builder.add(place, ir.Constant(place.type, entry))
            number = builder.fneg(builder.load(builder.gep(data, [k])))
            spread = _spread(builder, kind.dtype, number)
            product = builder.fmul(spread, others[entry % 3], flags=("contract",))
            found[entry // 3] = builder.fadd(found[entry // 3], product, flags=("contract",))
        return context.make_tuple(builder, sums, found)

    return sums(f, g, h, blocks, place, array, index, row), generate


@_in_loops
def zeros(typing: Any) -> Any:
    """A vector of zeros."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return ir.Constant(_LANES, [0.0] * LANES)

    return _VECTOR(), generate


@_in_loops
def plus_each(typing: Any, vector: Any, one: Any, other: Any) -> Any:
    """The sum of a vector and the products of the numbers of two others."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        vector, one, other = given
        product = builder.fmul(one, other, flags=("contract",))
        return builder.fadd(vector, product, flags=("contract",))

    return _VECTOR(vector, one, other), generate


@_in_loops
def thrice(typing: Any, vector: Any) -> Any:
    """The first three numbers of a vector for each row of a 3x3 block, but for the last entry."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        places = ir.Constant(ir.VectorType(_PLACE, LANES), [k % 3 for k in range(LANES)])
        return builder.shuffle_vector(given[0], ir.Constant(_LANES, ir.Undefined), places)

    return _VECTOR(vector), generate


@_in_loops
def row_sums(typing: Any, vector: Any) -> Any:
    """Sums over the rows of a 3x3 block, without its last entry."""
    sums = types.UniTuple(types.float64, 3)  # type: ignore[no-untyped-call]

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        found: list[Any] = [None, None, None]
        for k in range(LANES):
            number = builder.extract_element(given[0], ir.Constant(_PLACE, k))
            before = found[k // 3]
            found[k // 3] = number if before is None else builder.fadd(before, number)
        return context.make_tuple(builder, sums, found)

    return sums(vector), generate


@_in_loops
def block_of(typing: Any, f: Any, g: Any, h: Any) -> Any:
    """The 3x3 block, but for its last entry, whose rows three vectors begin with."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        f, g, h = given
        two = _shuffled(builder, f, g, (0, 1, 2, 8, 9, 10, 0, 0))
        return _shuffled(builder, two, h, (0, 1, 2, 3, 4, 5, 8, 9))

    return _VECTOR(f, g, h), generate


@_in_loops
def transposed(typing: Any, vector: Any) -> Any:
    """The transpose of a 3x3 block without its last entry, which stays."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return _shuffled(builder, given[0], given[0], (0, 3, 6, 1, 4, 7, 2, 5))

    return _VECTOR(vector), generate


@_in_loops
def plus_product(typing: Any, vector: Any, a: Any, a_rest: Any, b: Any, b_rest: Any) -> Any:
    """The sum of a 3x3 block and the product of two others, without its last entry.

    Both are given by their first eight entries, and by their last eight.
    """

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        found, a, a_rest, b, b_rest = given
        for left, right, column, row in ((a, b, 0, 0), (a, b, 1, 3), (a_rest, b_rest, 1, 5)):
            one = _shuffled(builder, left, left, tuple(column + k // 3 * 3 for k in range(LANES)))
            other = _shuffled(builder, right, right, tuple(row + k % 3 for k in range(LANES)))
            product = builder.fmul(one, other, flags=("contract",))
            found = builder.fadd(found, product, flags=("contract",))
        return found

    return _VECTOR(vector, a, a_rest, b, b_rest), generate


def _shuffled(builder: Any, one: Any, other: Any, places: tuple[int, ...]) -> Any:
    """Lanes of two vectors, those of the other from `LANES` on."""
    chosen = ir.Constant(ir.VectorType(_PLACE, LANES), list(places))
    return builder.shuffle_vector(one, other, chosen)


@_in_loops
def identity(typing: Any) -> Any:
    """The identity as a 3x3 block without its last entry."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return ir.Constant(_LANES, [float(k % 4 == 0) for k in range(LANES)])

    return _VECTOR(), generate


@_in_loops
def fetch(typing: Any, array: Any, index: Any) -> Any:
    """Ask memory for what a loop will read at an index of a flat array, within it or beyond."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        array, index = given
        data = context.make_array(signature.args[0])(context, builder, array).data
        byte = ir.IntType(8).as_pointer()
        address = builder.bitcast(builder.gep(data, [index]), byte)
        kind = ir.FunctionType(ir.VoidType(), [byte, _PLACE, _PLACE, _PLACE])
        prefetch = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
        # to read, for several times, as data
        builder.call(prefetch, [address, _PLACE(0), _PLACE(3), _PLACE(1)])
        return context.get_dummy_value()

    return types.void(array, index), generate
