//! Load of the machine by other programs.

use cpu_time::ProcessTime;
use std::time::Instant;
use sysinfo::System;

/// Watches the processor from its start on.
pub struct Load {
    system: Option<System>,
    own: ProcessTime,
    start: Instant,
}

impl Load {
    /// Starts to watch.
    pub fn start() -> Self {
        let mut system = System::new().ok();
        system.iter_mut().for_each(System::refresh_cpu_usage);
        Self { system, own: ProcessTime::now(), start: Instant::now() }
    }

    /// Logical processors that other programs kept busy since the start, on average, with what a hypervisor took away; `None` if the system
    /// does not tell, or if the time was too short for its count.
    pub fn others(mut self) -> Option<f64> {
        let seconds = self.start.elapsed().as_secs_f64();
        let own = self.own.elapsed().as_secs_f64() / seconds;
        if self.start.elapsed() < sysinfo::MINIMUM_CPU_UPDATE_INTERVAL {
            return None;
        }
        let system = self.system.as_mut()?;
        system.refresh_cpu_usage();
        let busy = 0.01 * f64::from(system.global_cpu_usage()) * system.cpus().len() as f64;
        Some((busy - own).max(0.0)).filter(|others| others.is_finite())
    }
}
