"""Structures that users bring, solved by shells once, and by multibody models whenever they change.

    python -m tests.concordance shells [NAME ...]    solve what is missing or out of date with shells
    python -m tests.concordance judge                solve all as multibody models, write docs/concordance.md

Definitions, targets and the rules of judging: docs/theory/concordance.md.
"""
