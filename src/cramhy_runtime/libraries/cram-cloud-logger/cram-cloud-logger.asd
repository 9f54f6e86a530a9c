(defsystem "cram-cloud-logger"
  :description "The names of the logger of openEASE's cloud. Nothing is sent: the episodes of this session are in cram-execution-trace."
  :depends-on ("cram-language" "cram-designators" "roslisp" "cram-utilities")
  :components ((:file "cram-cloud-logger")))
