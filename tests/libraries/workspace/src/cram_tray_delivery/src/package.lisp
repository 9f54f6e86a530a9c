(in-package :cl-user)

(defpackage :cram-tray-delivery
  (:nicknames :trays)
  (:use #:cpl)
  (:import-from #:alexandria #:with-gensyms)
  (:export #:delivery-log #:make-delivery-log #:note-delivery #:deliveries #:delivery-count #:wait-for-deliveries
           #:with-log-locked #:log-lock
           #:tray-dropped #:*trays-at-table* #:deliver-tray #:deliver-all #:carry))
