"""Every law of a metal's stress, one line each; the input file, its schema and its reference follow from it.

The keys of a law are the parameters of its class; a hardening curve gets its yield stress from the material.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from crumple.registry.registry import Registry

if TYPE_CHECKING:
    from crumple.material.hardening.curve import HardeningCurve
    from crumple.material.rate import RateLaw

HARDENING: Registry[type[HardeningCurve]] = Registry(
    "hardening curve",
    {
        "table": "crumple.material.hardening.table:HardeningTable",
        "swift": "crumple.material.hardening.swift:Swift",
        "voce": "crumple.material.hardening.voce:Voce",
    },
)
RATE: Registry[type[RateLaw]] = Registry(
    "strain-rate law",
    {
        "cowper-symonds": "crumple.material.rate:CowperSymonds",
        "johnson-cook": "crumple.material.rate:JohnsonCook",
    },
)
DEFAULT_RATE = "cowper-symonds"
"""Strain-rate law of a description that names none."""
