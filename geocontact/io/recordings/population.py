"""Description of a population: what differs from person to person, and how.

    [k]
    unit = "N/m"
    normal = { mean = 222, sd = 40, lower = 50 }

    [l]
    unit = "mm"
    uniform = { lower = 160, upper = 200 }

    [z]
    unit = "mm"
    value = 100

    [x]
    table = "measured.csv"

    [y]
    table = "measured.csv"

    [correlation]
    k_l = 0.4

Every quantity is described in one of these ways. A table is looked for beside the description and has a column for
each quantity that names it, with its unit; its people are drawn whole.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from jaxtyping import Float
from pydantic import AfterValidator, Field, FiniteFloat, create_model, model_validator

from geocontact.data.errors import InputError
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Beside, Document, checked
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import si_unit

LARGEST = 100_000
"""Bytes of the description."""
KINDS = ("value", "normal", "uniform", "table")
"""Ways in which a quantity may be described."""


class _Range(Document):
    """Numbers of which `upper` is above `lower`."""

    @property
    def numbers(self) -> dict[str, float]:
        """Those that are stated, by name."""
        return {name: value for name, value in self if value is not None}

    @model_validator(mode="after")
    def _require_order(self) -> _Range:
        if self.numbers.get("upper", math.inf) <= self.numbers.get("lower", -math.inf):
            raise refusal("is not above lower", "exchange them", at=("upper",))
        return self


class NormalDistribution(_Range):
    """A normal distribution.

    Parameters
    ----------
    mean, sd
        Mean and standard deviation before it is cut off.
    lower, upper
        Where it is cut off.
    """

    mean: FiniteFloat
    sd: Annotated[FiniteFloat, Field(gt=0.0)]
    lower: FiniteFloat | None = None
    upper: FiniteFloat | None = None


class UniformDistribution(_Range):
    """A uniform distribution.

    Parameters
    ----------
    lower, upper
        Smallest and largest value.
    """

    lower: FiniteFloat
    upper: FiniteFloat


class QuantityEntry(Document):
    """A quantity in one of four ways.

    Parameters
    ----------
    value
        The same for everybody.
    normal, uniform
        Distributions.
    table
        A .csv with a row for each person and the quantity among its columns.
    unit
        Unit of these numbers; a table has its own.
    """

    value: FiniteFloat | None = None
    normal: NormalDistribution | None = None
    uniform: UniformDistribution | None = None
    table: Beside | None = None
    unit: str | None = None

    @property
    def kind(self) -> str:
        """Which of `KINDS`."""
        return next(kind for kind in KINDS if getattr(self, kind) is not None)

    @property
    def numbers(self) -> dict[str, float]:
        """Those that are stated, by name."""
        one = self.normal or self.uniform
        return one.numbers if one is not None else {} if self.value is None else {"value": self.value}

    @model_validator(mode="after")
    def _require_one(self) -> QuantityEntry:
        count = sum(getattr(self, kind) is not None for kind in KINDS)
        if count != 1:
            raise refusal(f"is described in {count or 'no'} ways", f"give one of {', '.join(KINDS)}", at=("",))
        if self.table is not None and self.unit is not None:
            raise refusal("has no effect", "write it in the table", at=("unit",))
        return self


class PopulationDescription(Document):
    """Quantities by name, each a table of this kind, and how they go together.

    Parameters
    ----------
    correlation
        Rank correlation of two quantities by their names, as in x_y = 0.4, between -1 and 1.
    """

    correlation: Mapping[str, Annotated[FiniteFloat, Field(gt=-1.0, lt=1.0)]] = {}

    @property
    def quantities(self) -> dict[str, StatedQuantity]:
        """Quantities in SI, by name."""
        return {name: getattr(self, name) for name in type(self).model_fields if name != "correlation"}

    @property
    def pairs(self) -> dict[tuple[str, str], float]:
        """Correlations by the names of both quantities."""
        return {(key.partition("_")[0], key.partition("_")[2]): value for key, value in self.correlation.items()}

    @model_validator(mode="after")
    def _require_pairs(self) -> PopulationDescription:
        for k, (first, second) in enumerate(self.pairs):
            at = ("correlation", f"{first}_{second}")
            if first == second or not {first, second} <= {*self.quantities}:
                raise refusal("is not a pair of quantities", "write x_y = 0.4", at=at)
            for name in (first, second):
                if (kind := self.quantities[name].kind) in ("table", "value"):
                    remedy = "a table brings its own correlation, a value has none"
                    raise refusal(f"{name} is described by {kind}", remedy, at=at)
            if (second, first) in [*self.pairs][:k]:
                raise refusal("occurs twice", "keep one", at=at)
        return self


@dataclass(frozen=True)
class StatedQuantity:
    """A quantity: its kind, and its numbers in SI units, `value` or those of the distribution.

    `factor` is how many SI units the unit is that stands beside them; `table` where it is described by one.
    """

    kind: str
    numbers: Mapping[str, float]
    factor: float = 1.0
    table: Path | None = None


@dataclass(frozen=True, eq=False)
class PopulationFile:
    """Quantities by name, tables of people by file with their columns by name, and correlations by pair of names."""

    quantities: dict[str, StatedQuantity]
    tables: dict[Path, dict[str, Float[np.ndarray, " m"]]]
    correlations: dict[tuple[str, str], float]


def read_population(path: Path, units: Mapping[str, str]) -> PopulationFile:
    """The description, with `units` the SI units of the quantities that have to be in it; InputError otherwise."""
    fields: dict[str, Any] = {
        name: (Annotated[QuantityEntry, AfterValidator(_InUnit(unit))], ...) for name, unit in units.items()
    }
    kind = create_model("Population", __base__=PopulationDescription, **fields)
    described: PopulationDescription = checked(path, kind, toml_of(path, LARGEST))
    tables: dict[Path, dict[str, Float[np.ndarray, " m"]]] = {}
    for name, one in described.quantities.items():
        if one.table is not None:
            tables.setdefault(one.table, {})[name] = _column(one.table, name, units[name])
    return PopulationFile(described.quantities, tables, described.pairs)


@dataclass(frozen=True)
class _InUnit:
    """What turns an entry into SI; a refusal of a unit that is not of `si`."""

    si: str

    def __call__(self, entry: QuantityEntry) -> StatedQuantity:
        if entry.table is not None:
            return StatedQuantity("table", {}, table=entry.table)
        known = si_unit(entry.unit or "")
        if known is None or known[0] != self.si:
            what = "is missing" if entry.unit is None else f"{entry.unit!r:.60} is not a unit of it"
            raise refusal(what, f"write {self.si}, or another one of its kind", at=("unit",))
        numbers = {name: known[1] * value for name, value in entry.numbers.items()}
        return StatedQuantity(entry.kind, numbers, known[1])


def _column(file: Path, name: str, unit: str) -> Float[np.ndarray, " m"]:
    label = f"{name} [{unit}]"
    table = read_side_table(file, (label,))
    if label not in table:
        what = f"no column '{name}' in {unit} or a multiple; columns are: {', '.join(map(str, table.columns))}"
        raise InputError(file, "line 1", what, f"write {label}")
    return table[label].to_numpy(float)
