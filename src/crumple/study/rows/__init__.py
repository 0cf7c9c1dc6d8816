"""What solves the rows of a study: the batch kernels, processes, or a function of the caller's."""

from crumple.study.rows.batch import BatchModel, batched, masses_of
from crumple.study.rows.function import FunctionModel
from crumple.study.rows.laws import changed_laws
from crumple.study.rows.layouts import LayoutModel, layout_place, without
from crumple.study.rows.model import COMPLETE, Model, Row
from crumple.study.rows.process import ProcessModel

__all__ = [
    "COMPLETE",
    "BatchModel",
    "FunctionModel",
    "LayoutModel",
    "Model",
    "ProcessModel",
    "Row",
    "batched",
    "changed_laws",
    "layout_place",
    "masses_of",
    "without",
]
