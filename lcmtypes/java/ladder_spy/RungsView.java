// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics2D;
import javax.swing.Action;
import javax.swing.JDesktopPane;

import ladder_msgs.ladder_t;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy plugin: rungs, rails and grasps in two projections. Thick green: a gripper may close there; yellow: trusted, but not there; grey: candidate. */
public final class RungsView implements SpyPlugin {
    private static final Color RAIL = new Color(110, 110, 150);
    private static final Color TRUSTED = new Color(230, 200, 60);
    private static final Color CANDIDATE = new Color(130, 130, 130);
    private static final Color FEASIBLE = new Color(60, 210, 90);
    private static final double AHEAD_M = 3.0;

    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == ladder_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return LiveView.opener("Rungs", desktop, channel, View::new);
    }

    private static final class View extends LiveView {
        View(ChannelData channel) {
            super(channel, 66, new Dimension(1000, 640));
        }

        @Override
        protected void draw(Graphics2D graphics) {
            if (!(channel.last instanceof ladder_t)) return;
            final ladder_t m = (ladder_t) channel.last;
            final Projections view = new Projections(graphics, getWidth(), getHeight(), AHEAD_M, middleOf(m));
            for (int i = 0; i < m.num_rails; ++i) {
                view.line(m.rail_x0_m[i], m.rail_y0_m[i], m.rail_z0_m[i], m.rail_x1_m[i], m.rail_y1_m[i], m.rail_z1_m[i], RAIL, 2.0);
            }
            int trusted = 0;
            for (int i = 0; i < m.num_rungs; ++i) {
                final boolean isTrusted = m.rung_state[i] == ladder_t.RUNG_TRUSTED;
                trusted += isTrusted ? 1 : 0;
                stretch(view, m, i, 0.0, 1.0, isTrusted ? TRUSTED : CANDIDATE, 2.0);
            }
            for (int i = 0; i < m.num_intervals; ++i) {
                final int rung = m.interval_rung[i];
                if (m.interval_reason[i] != ladder_t.REASON_NONE || rung < 0 || rung >= m.num_rungs) continue;
                final double length = lengthOf(m, rung);
                if (length > 0.0) stretch(view, m, rung, m.interval_from_m[i] / length, m.interval_to_m[i] / length, FEASIBLE, 6.0);
            }
            for (int i = 0; i < m.num_grasps; ++i) {
                view.point(m.grasp_x_m[i], m.grasp_y_m[i], m.grasp_z_m[i], Color.WHITE, 0.012);
            }
            final String state = m.ladder_state == ladder_t.LADDER_CONFIRMED ? String.format("ladder, rungs %.3f m apart", m.spacing_m) : "no ladder";
            graphics.setColor(Color.LIGHT_GRAY);
            graphics.drawString(state + ": " + trusted + " of " + m.num_rungs + " rungs trusted; green: may be grasped", 8, getHeight() - 8);
        }

        /** The mean height of all rungs. */
        private static double middleOf(ladder_t m) {
            double sum = 0.0;
            for (int i = 0; i < m.num_rungs; ++i) sum += 0.5 * (m.rung_z0_m[i] + m.rung_z1_m[i]);
            return m.num_rungs > 0 ? sum / m.num_rungs : 1.0;
        }

        private static double lengthOf(ladder_t m, int i) {
            final double x = m.rung_x1_m[i] - m.rung_x0_m[i];
            final double y = m.rung_y1_m[i] - m.rung_y0_m[i];
            final double z = m.rung_z1_m[i] - m.rung_z0_m[i];
            return Math.sqrt(x * x + y * y + z * z);
        }

        /** The part of a rung between two shares of its length. */
        private static void stretch(Projections view, ladder_t m, int i, double from, double to, Color color, double widthPx) {
            final double x = m.rung_x1_m[i] - m.rung_x0_m[i];
            final double y = m.rung_y1_m[i] - m.rung_y0_m[i];
            final double z = m.rung_z1_m[i] - m.rung_z0_m[i];
            view.line(m.rung_x0_m[i] + from * x, m.rung_y0_m[i] + from * y, m.rung_z0_m[i] + from * z,
                      m.rung_x0_m[i] + to * x, m.rung_y0_m[i] + to * y, m.rung_z0_m[i] + to * z, color, widthPx);
        }
    }
}
