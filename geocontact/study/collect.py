"""The tables of all trials together, written trial after trial: memory holds a part of them at a time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from geocontact.io.results import RaggedTable, write_ragged
from geocontact.study.store import Store
from geocontact.study.trials import CohortTrial

NAME = "name"
ROWS = 1 << 16
"""Rows that are written at a time, at least."""
Kept = tuple[CohortTrial, str]


@dataclass(frozen=True)
class Part:
    """The table of one trial: where it is, how many rows it has."""

    trial: CohortTrial
    file: Path
    rows: int


def collect(kept: Sequence[Kept], store: Store, folder: Path) -> list[str]:
    """Write each table that trials have as .parquet and .nc into `folder`; their names."""
    names = dict.fromkeys(name for _, address in kept for name in store.report(address)["tables"])
    for name in names:
        parts = list(_parts(kept, store, name))
        schema = _schema(parts)
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        together = target.with_name(f"{target.name}.parquet")
        _write_parquet(parts, schema, together)
        ragged = RaggedTable(name, [_labels(part.trial) for part in parts], [part.rows for part in parts])
        write_ragged(ragged, _columns(together, schema), target.with_name(f"{target.name}.nc"))
    return list(names)


def _parts(kept: Sequence[Kept], store: Store, name: str) -> Iterator[Part]:
    for trial, address in kept:
        file = store.place(address) / f"{name}.parquet"
        if file.is_file():
            yield Part(trial, file, pq.ParquetFile(file).metadata.num_rows)


def _schema(parts: Sequence[Part]) -> pa.Schema:
    """Columns of all trials in the order in which they come first; whole numbers and others together are others."""
    kinds: dict[str, pa.DataType] = {}
    for part in parts:
        for column in pq.read_schema(part.file):
            known = kinds.get(column.name, column.type)
            kinds[column.name] = known if known == column.type else _common(known, column.type)
    return pa.schema([pa.field(name, kind) for name, kind in kinds.items()])


def _common(one: pa.DataType, other: pa.DataType) -> pa.DataType:
    """A type that holds both: the other one where one is empty, numbers as real ones, else text."""
    if pa.types.is_null(one) or pa.types.is_null(other):
        return other if pa.types.is_null(one) else one
    numbers = all(pa.types.is_integer(each) or pa.types.is_floating(each) for each in (one, other))
    return pa.float64() if numbers else pa.string()


def _labels(trial: CohortTrial) -> dict[str, str]:
    """Name and factors, as text: what one trial has as a number another may have as a word."""
    return {NAME: trial.name, **{name: str(value) for name, value in trial.factors.items()}}


def _write_parquet(parts: Sequence[Part], schema: pa.Schema, file: Path) -> None:
    labels = list(dict.fromkeys(name for part in parts for name in _labels(part.trial)))
    whole = pa.schema([*(pa.field(_free(name, schema), pa.string()) for name in labels), *schema])
    with pq.ParquetWriter(file, whole) as writer:
        waiting: list[pa.Table] = []
        for part in parts:
            waiting.append(_labelled(part, labels, schema, whole))
            if sum(table.num_rows for table in waiting) >= ROWS:
                writer.write_table(pa.concat_tables(waiting).combine_chunks())
                waiting = []
        if waiting:
            writer.write_table(pa.concat_tables(waiting).combine_chunks())


def _free(label: str, schema: pa.Schema) -> str:
    """A name that no column has: a table may have a column `subject` of its own."""
    return label if label not in schema.names else f"study {label}"


def _labelled(part: Part, labels: Sequence[str], schema: pa.Schema, whole: pa.Schema) -> pa.Table:
    own = _labels(part.trial)
    table = _as_in(pq.read_table(part.file), schema)
    texts = [pa.array([own.get(name)] * part.rows, pa.string()) for name in labels]
    return pa.table([*texts, *table.columns], schema=whole)


def _as_in(table: pa.Table, schema: pa.Schema) -> pa.Table:
    """With the columns of all trials; those that this one has not are empty."""
    columns = [
        table[column.name].cast(column.type)
        if column.name in table.column_names
        else pa.nulls(table.num_rows, column.type)
        for column in schema
    ]
    return pa.table(columns, schema=schema)


def _columns(file: Path, schema: pa.Schema) -> Iterator[tuple[str, bool, Iterator[Any]]]:
    """Name of each column, whether it is text, and its values a part at a time, from the table of all trials."""
    for column in schema:
        text = not (pa.types.is_integer(column.type) or pa.types.is_floating(column.type))
        yield column.name, text, _values(file, column.name)


def _values(file: Path, column: str) -> Iterator[Any]:
    with pq.ParquetFile(file) as whole:
        for batch in whole.iter_batches(ROWS, columns=[column]):
            yield batch.column(0).to_pandas().to_numpy()
