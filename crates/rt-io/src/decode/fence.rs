//! Turns a panic of a decoder into an error.
//!
//! A panic is caught where it unwinds. A program built with `panic = "abort"` cannot catch one; the kinds of file on
//! which the decoders are known to panic are refused before they see them, and what is left ends such a program.

use std::any::Any;
use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;
use std::thread;

thread_local! {
    /// Whether this thread is inside a fence, so that its panics are not printed.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// What `work` gives, or the message of its panic, which is not printed.
///
/// The first call puts a hook before the process's panic hook, once and for all threads; it asks the thread-local flag
/// alone, and passes everything else on. A hook that a program sets later prints the message; the panic is caught all
/// the same.
pub(super) fn fenced<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    // A thread that is panicking already may not change the hook.
    if !thread::panicking() {
        HOOK.call_once(|| {
            let hook = panic::take_hook();
            panic::set_hook(Box::new(move |info| {
                if !INSIDE.get() {
                    hook(info);
                }
            }));
        });
    }
    let outer = INSIDE.replace(true);
    // What `work` has built is dropped with it, so that no broken state is visible.
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    INSIDE.set(outer);
    result.map_err(|payload| message(&*payload))
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_string());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_message_and_the_fence_ends_with_it() {
        assert_eq!(fenced(|| 7), Ok(7));
        assert_eq!(fenced(|| -> u8 { panic!("on purpose") }), Err("on purpose".to_string()));
        let number = 7;
        assert_eq!(fenced(|| -> u8 { panic!("number {number}") }), Err("number 7".to_string()));
        assert_eq!(fenced(|| -> u8 { panic::panic_any(7) }), Err("a panic".to_string()));
        assert!(!INSIDE.get());
        // A fence within a fence leaves the outer one closed.
        let inner = fenced(|| (fenced(|| -> u8 { panic!("inner") }), INSIDE.get()));
        assert_eq!(inner, Ok((Err("inner".to_string()), true)));
    }
}
