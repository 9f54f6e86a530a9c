"""``def-desig-package``: a package whose property names are shared (designators.md section 5). Legacy; keywords make it unnecessary."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import python_list
from cramhy_runtime.lisp_core.packages import symbol_name
from ...packages.package_definition import define_package
from cramhy_runtime.designators.symbols import DESIG_PROPS


def define_designator_package(name, options):
    """Define the package ``name`` with the options of ``defpackage`` and ``(:desig-properties symbol...)``; returns it."""
    properties, rest = [], []
    for option in python_list(options):
        if option.car.name == "DESIG-PROPERTIES":
            properties += [symbol_name(symbol) for symbol in python_list(option.cdr)]
        else:
            rest.append(option)
    package = define_package(name, rest)
    for property_name in properties:
        symbol = DESIG_PROPS.intern(property_name)
        DESIG_PROPS.export(symbol)
        package.shadowing_import(symbol)
    return package
