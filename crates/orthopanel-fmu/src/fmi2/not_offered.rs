//! FMI 2.0 functions of capabilities that the FMU does not offer.

use crate::boundary::not_offered;

not_offered! {
    "canRunAsynchronuously = false":
        fmi2CancelStep();
}
