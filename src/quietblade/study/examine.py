# SPDX-License-Identifier: LGPL-2.1-or-later
"""One door to what can be known of any case before it runs."""

from quietblade.case import AnyCase, BodyCase, Case
from quietblade.study.body_preflight import body_preflight
from quietblade.study.preflight import Surroundings, preflight


def examine(case: AnyCase) -> Surroundings:
    """Check everything that can be checked before meshing.

    Returns
    -------
    Surroundings
        A `Preflight` of a blade, a `BodyPreflight` of another body.

    Raises
    ------
    InvalidCaseError
        What the tables say together is impossible; each with file, line, key, value and remedy.
    """
    if isinstance(case, BodyCase):
        return body_preflight(case)
    assert isinstance(case, Case)
    return preflight(case)
