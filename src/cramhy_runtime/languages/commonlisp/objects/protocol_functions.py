"""The generic functions by which objects are made, initialized, updated and printed (ANSI 7.1 to 7.3).

They stand below the modules that call them; ``protocol.py``, above these, gives them their default methods.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.dispatch.generic_functions import generic

_INITARGS = "&rest initargs &key &allow-other-keys)"
allocate_instance = generic("ALLOCATE-INSTANCE", f"(class {_INITARGS}")
initialize_instance = generic("INITIALIZE-INSTANCE", f"(instance {_INITARGS}")
reinitialize_instance = generic("REINITIALIZE-INSTANCE", f"(instance {_INITARGS}")
shared_initialize = generic("SHARED-INITIALIZE", f"(instance slot-names {_INITARGS}")
change_class = generic("CHANGE-CLASS", f"(instance new-class {_INITARGS}")
update_instance_for_different_class = generic("UPDATE-INSTANCE-FOR-DIFFERENT-CLASS", f"(previous current {_INITARGS}")
update_instance_for_redefined_class = generic(
    "UPDATE-INSTANCE-FOR-REDEFINED-CLASS", f"(instance added-slots discarded-slots property-list {_INITARGS}"
)
slot_unbound = generic("SLOT-UNBOUND", "(class instance slot-name)")
slot_missing = generic("SLOT-MISSING", "(class instance slot-name operation &optional new-value)")
no_applicable_method = generic("NO-APPLICABLE-METHOD", "(generic-function &rest arguments)")
no_next_method = generic("NO-NEXT-METHOD", "(generic-function method &rest arguments)")
print_object = generic("PRINT-OBJECT", "(object stream)")
make_load_form = generic("MAKE-LOAD-FORM", "(object &optional environment)")
