"""Parameters of the modelling manager; config/modelling_manager.yaml has the same keys."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class ManagerOptions:
    service_wait_s: float = 5.0  # for a service or action to be offered
    call_timeout_s: float = 60.0  # for the answer of a service
    job_silence_s: float = 10.0  # of a node that works on a job, until it counts as gone

    def violations(self):
        return [
            "%s = %g: must be within [0.1, 3600]" % (field.name, getattr(self, field.name))
            for field in dataclasses.fields(self)
            if not 0.1 <= getattr(self, field.name) <= 3600
        ]
