//! Many runs on all processors, in an order that no result depends on.

use denavit_simulate::scenario::Scenario;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// Sees how far work has come: done, of all. Says whether to go on; if not, what is done is the
/// answer.
pub type Observer<'a> = dyn Fn(usize, usize) -> bool + Sync + 'a;

/// Makes the same scenario anew, for each processor; none where its files are there no more.
pub type Opener<'a> = dyn Fn() -> Option<Scenario> + Sync + 'a;

/// The results of `work` for 0, 1, .. `count`, each on a worker that `worker` makes once for each
/// processor.
pub(super) fn each<W, R: Send>(
    count: usize,
    observer: &Observer<'_>,
    worker: &(dyn Fn() -> W + Sync),
    work: &(dyn Fn(&mut W, usize) -> R + Sync),
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let done = AtomicUsize::new(0);
    let is_stopped = AtomicBool::new(false);
    let results: Mutex<Vec<Option<R>>> = Mutex::new((0..count).map(|_| None).collect());
    let processors = thread::available_parallelism().map_or(1, usize::from).min(count.max(1));
    thread::scope(|scope| {
        for _ in 0..processors {
            scope.spawn(|| {
                let mut own = worker();
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count || is_stopped.load(Ordering::Relaxed) {
                        return;
                    }
                    let result = work(&mut own, index);
                    if let Ok(mut results) = results.lock() {
                        results[index] = Some(result);
                    }
                    if !observer(done.fetch_add(1, Ordering::Relaxed) + 1, count) {
                        is_stopped.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
    });
    results.into_inner().unwrap_or_default().into_iter().flatten().collect()
}
